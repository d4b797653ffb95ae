#include "harness/scene_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "groups/decimal.h"
#include "groups/quaternion.h"
#include "harness/errors.h"

namespace liebench {

namespace {

constexpr std::size_t longest_name = 64;
constexpr std::size_t most_terms = 20;
// A list of names in a message: more are not read.
constexpr std::size_t most_names_shown = 12;

}  // namespace

double read_number(const JsonView& view) {
  return view.number_in(-largest_scene_number, largest_scene_number);
}

double read_positive(const JsonView& view) {
  const std::string allowed =
      fmt::format("a positive number from {} to {}", smallest_scene_number, largest_scene_number);
  const double x = view.number(allowed);
  if (!(x >= smallest_scene_number && x <= largest_scene_number)) view.reject(allowed);
  return x;
}

double read_not_negative(const JsonView& view) {
  return view.number_in(0.0, largest_scene_number);
}

void require_count(const JsonView& view, std::size_t count, std::string_view allowed) {
  if (!view.is_array() || view.size() != count) view.reject(allowed);
}

Eigen::Vector3d read_vector(const JsonView& view) {
  require_count(view, 3, "a list of 3 numbers");
  return {read_number(view[0]), read_number(view[1]), read_number(view[2])};
}

Eigen::Vector3d read_not_negative_vector(const JsonView& view) {
  require_count(view, 3, "a list of 3 numbers that are not negative");
  return {read_not_negative(view[0]), read_not_negative(view[1]), read_not_negative(view[2])};
}

Eigen::Vector3d read_direction(const JsonView& view) {
  const Eigen::Vector3d v = read_vector(view);
  if (!(v.stableNorm() >= smallest_scene_number))
    view.reject("a direction: a list of 3 numbers that are not all zero");
  return v;
}

std::string read_name(const JsonView& view) {
  constexpr std::string_view allowed =
      "a name of 1 to 64 letters, digits, spaces, \"_\", \".\" and \"-\" that begins with a letter, a digit "
      "or \"_\"";
  if (!view.value().is_string()) view.reject(allowed);
  const std::string name = view.text();
  const auto word = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
  };
  const bool good = !name.empty() && name.size() <= longest_name && word(name.front()) &&
                    std::all_of(name.begin(), name.end(),
                                [&](char c) { return word(c) || c == ' ' || c == '.' || c == '-'; });
  if (!good) view.reject(allowed);
  return name;
}

PrescribedMotion<double> read_motion(const JsonView& view) {
  view.require_object({"polynomial", "sines"});
  if (!view.has("polynomial") && !view.has("sines")) view.reject("\"polynomial\", \"sines\" or both");
  const auto list = [&](const char* key) {
    const JsonView terms = view[key];
    if (!terms.is_array() || terms.size() == 0 || terms.size() > most_terms)
      terms.reject(fmt::format("a list of 1 to {} terms", most_terms));
    return terms;
  };
  PrescribedMotion<double> motion;
  if (view.has("polynomial")) {
    const JsonView terms = list("polynomial");
    for (std::size_t i = 0; i < terms.size(); ++i) motion.polynomial.push_back(read_number(terms[i]));
  }
  if (view.has("sines")) {
    const JsonView terms = list("sines");
    for (std::size_t i = 0; i < terms.size(); ++i) {
      const JsonView term = terms[i];
      term.require_object({"amplitude", "angular_frequency", "phase"});
      for (const char* key : {"amplitude", "angular_frequency"}) term.require_key(key);
      motion.sines.push_back({read_number(term["amplitude"]), read_number(term["angular_frequency"]),
                              term.has("phase") ? read_number(term["phase"]) : 0.0});
    }
  }
  return motion;
}

void require_one_of(const JsonView& object, const std::vector<std::string>& keys) {
  std::string found;
  for (const std::string& key : keys) {
    if (!object.has(key)) continue;
    if (!found.empty()) object[key].reject(fmt::format("either \"{}\" or \"{}\", not both", found, key));
    found = key;
  }
  if (found.empty()) object.reject(fmt::format("an object with the key {}", quoted_list(keys)));
}

void SceneNames::add(const JsonView& view, const std::string& name) {
  if (!index_.emplace(name, int(names_.size())).second)
    view.reject(fmt::format("a name that no other {} has", what_));
  names_.push_back(name);
}

int SceneNames::find(const JsonView& view) const {
  const auto found = index_.find(view.text());
  if (found == index_.end()) reject_unknown(view, false);
  return found->second;
}

int SceneNames::find_or_ground(const JsonView& view) const {
  const std::string name = view.text();
  if (name == ground_name) return -1;
  const auto found = index_.find(name);
  if (found == index_.end()) reject_unknown(view, true);
  return found->second;
}

void SceneNames::reject_unknown(const JsonView& view, bool ground) const {
  std::vector<std::string> allowed = names_;
  if (ground) allowed.emplace_back(ground_name);
  const std::string hint = suggestion(view.text(), allowed);
  std::string list = "none: the scene names none";
  if (allowed.size() > most_names_shown) {
    const std::size_t more = allowed.size() - most_names_shown;
    allowed.resize(most_names_shown);
    list = fmt::format("{} and {} more", quoted_list(allowed), more);
  } else if (!allowed.empty()) {
    list = quoted_list(allowed);
  }
  throw InputError(view.pointer(), fmt::format("unknown {} \"{}\"; allowed: {}{}", what_,
                                               shortened(view.text()), list, hint));
}

InitialFrame::InitialFrame(const SceneDescription& scene, int body) {
  if (body < 0) {
    x_.setConstant(Extended(0.0));
    R_.setIdentity();
    return;
  }
  const BodyDescription& d = scene.bodies[std::size_t(body)];
  x_ = decimal_vector<Extended>(d.position);
  Quaternion<Extended> p;
  for (Eigen::Index i = 0; i < 4; ++i) p(i) = decimal<Extended>(d.orientation(i));
  R_ = rotation_matrix<Extended>(Quaternion<Extended>(p / p.norm()));
}

Eigen::Vector3d rounded(const InitialFrame::Vector& v) {
  return {to_double(v(0)), to_double(v(1)), to_double(v(2))};
}

BodyPair read_body_pair(const JsonView& view, const SceneNames& bodies) {
  require_count(view, 2, "a list of two bodies, one of which may be \"ground\"");
  const BodyPair pair{bodies.find_or_ground(view[0]), bodies.find_or_ground(view[1])};
  if (pair.a == pair.b) view.reject("two bodies that are not the same");
  return pair;
}

PointPair read_point_pair(const JsonView& object, const SceneDescription& scene, BodyPair pair) {
  require_one_of(object, {"point", "points"});
  if (object.has("points")) {
    const JsonView points = object["points"];
    require_count(points, 2, "a list of two points, one in the frame of each body");
    return {read_vector(points[0]), read_vector(points[1])};
  }
  const auto point = decimal_vector<Extended>(read_vector(object["point"]));
  return {rounded(InitialFrame(scene, pair.a).to_body(point)),
          rounded(InitialFrame(scene, pair.b).to_body(point))};
}

double initial_distance(const SceneDescription& scene, BodyPair pair, const PointPair& points) {
  const auto place = [&](int body, const Eigen::Vector3d& point) {
    return InitialFrame(scene, body).to_inertial(decimal_vector<Extended>(point));
  };
  return to_double(InitialFrame::Vector(place(pair.b, points.b) - place(pair.a, points.a)).norm());
}

}  // namespace liebench
