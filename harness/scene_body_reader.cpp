#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <array>
#include <cmath>
#include <numbers>

#include "groups/decimal.h"
#include "groups/quaternion.h"
#include "harness/errors.h"
#include "harness/scene_parts.h"

namespace liebench {

namespace {

struct Formulation {
  std::string_view name;
  BodyKind kind;
};

// Every group that a body may move on: the explicit list, the default first.
constexpr std::array body_formulations{
    Formulation{"R3xSO3", BodyKind::r3xso3}, Formulation{"R3xS3", BodyKind::r3xs3},
    Formulation{"SE3", BodyKind::se3},       Formulation{"S3|xR3", BodyKind::s3_r3},
    Formulation{"UDQ", BodyKind::udq},       Formulation{"SO3", BodyKind::so3},
    Formulation{"S3", BodyKind::s3},         Formulation{"R3", BodyKind::r3}};

Formulation read_formulation(const JsonView& body) {
  if (!body.has("formulation")) return body_formulations.front();
  std::vector<std::string> names;
  for (const Formulation& f : body_formulations) names.emplace_back(f.name);
  const std::string name = body["formulation"].word(names, "formulation");
  for (const Formulation& f : body_formulations)
    if (f.name == name) return f;
  return body_formulations.front();
}

// The index of the axis that a shape has as a word.
Eigen::Index read_shape_axis(const JsonView& shape, std::string_view fallback) {
  const std::string axis =
      shape.has("axis") ? shape["axis"].word({"x", "y", "z"}, "axis") : std::string(fallback);
  return axis == "x" ? 0 : axis == "y" ? 1 : 2;
}

// Of a homogeneous body of mass 1: its volume, m^3, and its principal moments, m^2.
struct Shape {
  double volume;
  Eigen::Vector3d moments;
};

Shape box_shape(const Eigen::Vector3d& size) {
  const Eigen::Vector3d squares = size.cwiseAbs2();
  return {size.prod(), (Eigen::Vector3d::Constant(squares.sum()) - squares) / 12.0};
}

Shape read_shape(const JsonView& view) {
  if (!view.value().is_object()) view.reject("an object with the key \"type\"");
  view.require_key("type");
  const std::string type = view["type"].word({"box", "sphere", "cylinder", "rod"}, "shape");
  const auto keys = [&](const std::vector<std::string>& required, const std::vector<std::string>& optional) {
    std::vector<std::string> all{"type"};
    all.insert(all.end(), required.begin(), required.end());
    all.insert(all.end(), optional.begin(), optional.end());
    all.emplace_back("density");
    view.require_object(all);
    for (const std::string& key : required) view.require_key(key);
  };
  if (type == "box") {
    keys({"size"}, {});
    const JsonView size = view["size"];
    require_count(size, 3, "a list of 3 positive lengths");
    return box_shape({read_positive(size[0]), read_positive(size[1]), read_positive(size[2])});
  }
  if (type == "sphere") {
    keys({"radius"}, {});
    const double r = read_positive(view["radius"]);
    return {4.0 / 3.0 * std::numbers::pi * r * r * r, Eigen::Vector3d::Constant(0.4 * r * r)};
  }
  if (type == "cylinder") {
    keys({"radius", "length"}, {"axis"});
    const double r = read_positive(view["radius"]), length = read_positive(view["length"]);
    Shape shape{std::numbers::pi * r * r * length,
                Eigen::Vector3d::Constant((3.0 * r * r + length * length) / 12.0)};
    shape.moments(read_shape_axis(view, "z")) = 0.5 * r * r;
    return shape;
  }
  keys({"length", "width"}, {"axis"});
  Eigen::Vector3d size = Eigen::Vector3d::Constant(read_positive(view["width"]));
  size(read_shape_axis(view, "x")) = read_positive(view["length"]);
  return box_shape(size);
}

// What a body of positive mass everywhere can have.
void require_possible(const Eigen::Matrix3d& inertia, const JsonView& view) {
  constexpr std::string_view shape =
      "3 positive principal moments, or a symmetric positive definite 3 x 3 matrix as a list of rows";
  if (inertia != inertia.transpose()) view.reject(shape);
  const double scale = inertia.cwiseAbs().maxCoeff();
  if (!(scale >= smallest_scene_number)) view.reject(shape);
  const Eigen::Vector3d moments =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(inertia / scale, Eigen::EigenvaluesOnly).eigenvalues();
  // The eigenvalues of a singular matrix come out within round-off of zero.
  if (!(moments(0) > 1e-14)) view.reject(shape);
  // A flat body has equality, but for the rounding of its data.
  if (!(moments(0) + moments(1) >= moments(2) * (1.0 - 1e-9)))
    view.reject(
        fmt::format("principal moments of which none exceeds the sum of the others; these are {:.6g}, {:.6g} "
                    "and {:.6g}",
                    moments(0) * scale, moments(1) * scale, moments(2) * scale));
}

Eigen::Matrix3d read_inertia(const JsonView& view) {
  require_count(view, 3, "3 principal moments, or a 3 x 3 matrix as a list of rows");
  Eigen::Matrix3d J = Eigen::Matrix3d::Zero();
  if (view[0].is_array())
    for (Eigen::Index i = 0; i < 3; ++i) J.row(i) = read_vector(view[std::size_t(i)]).transpose();
  else
    J.diagonal() = read_vector(view);
  require_possible(J, view);
  return J;
}

void read_mass_and_inertia(const JsonView& view, BodyDescription& body) {
  if (body.kind == BodyKind::r3) {
    view.require_key("mass");
    body.mass = read_positive(view["mass"]);
    return;
  }
  require_one_of(view, {"inertia", "shape"});
  if (view.has("inertia")) {
    view.require_key("mass");
    body.mass = read_positive(view["mass"]);
    body.inertia = read_inertia(view["inertia"]);
    return;
  }
  const JsonView shape = view["shape"];
  const Shape unit = read_shape(shape);
  if (view.has("mass") == shape.has("density"))
    view.reject("either \"mass\" or the \"density\" of the \"shape\", just one of them");
  if (view.has("mass")) {
    body.mass = read_positive(view["mass"]);
  } else {
    body.mass = read_positive(shape["density"]) * unit.volume;
    if (!(body.mass >= smallest_scene_number && body.mass <= largest_scene_number))
      shape.reject(fmt::format("a shape of a mass from {} to {} kg; this is {:.6g} kg", smallest_scene_number,
                               largest_scene_number, body.mass));
  }
  body.inertia = (body.mass * unit.moments).asDiagonal();
  require_possible(body.inertia, shape);
}

// As a unit quaternion.
Eigen::Vector4d read_orientation(const JsonView& body) {
  Quaternion<Extended> p;
  if (body.has("rotation")) {
    if (body.has("orientation")) body["rotation"].reject("either \"orientation\" or \"rotation\", not both");
    const JsonView rotation = body["rotation"];
    rotation.require_object({"axis", "angle"});
    for (const char* key : {"axis", "angle"}) rotation.require_key(key);
    const Extended half = decimal<Extended>(rotation["angle"].number_in(-1e6, 1e6)) * Extended(0.5);
    InitialFrame::Vector axis = decimal_vector<Extended>(read_direction(rotation["axis"]));
    axis /= axis.cwiseAbs().maxCoeff();
    p(0) = cos(half);
    p.tail<3>() = sin(half) / axis.norm() * axis;
  } else {
    const JsonView view = body["orientation"];
    constexpr std::string_view allowed = "a quaternion: a list of 4 numbers w, x, y, z that are not all zero";
    require_count(view, 4, allowed);
    double largest = 0.0;
    for (std::size_t i = 0; i < 4; ++i) {
      const double x = read_number(view[i]);
      p(Eigen::Index(i)) = decimal<Extended>(x);
      largest = std::max(largest, std::abs(x));
    }
    if (!(largest >= smallest_scene_number)) view.reject(allowed);
    p /= Extended(largest);
  }
  p /= p.norm();
  return {to_double(p(0)), to_double(p(1)), to_double(p(2)), to_double(p(3))};
}

// Keys that say nothing about a body of this kind.
void require_meaning(const JsonView& view, const Formulation& formulation) {
  const auto forbid = [&](std::initializer_list<const char*> keys, std::string_view reason) {
    for (const char* key : keys)
      if (view.has(key))
        throw InputError(
            view.pointer() + "/" + key,
            fmt::format("means nothing for a body on {}, {}; leave it out", formulation.name, reason));
  };
  if (formulation.kind == BodyKind::r3)
    forbid({"inertia", "shape", "orientation", "rotation", "angular_velocity", "gyroscopic"},
           "a point mass that does not turn");
  if (has_fixed_point(formulation.kind))
    forbid({"velocity"}, "which follows from \"angular_velocity\" and \"fixed_point\"");
  else
    forbid({"fixed_point"}, "only for one on SO3 or S3");
}

}  // namespace

BodyDescription read_body(const JsonView& view) {
  view.require_object({"name", "mass", "inertia", "shape", "position", "orientation", "rotation", "velocity",
                       "angular_velocity", "formulation", "fixed_point", "gyroscopic"});
  view.require_key("name");
  BodyDescription body;
  body.name = read_name(view["name"]);
  if (body.name == ground_name) view["name"].reject("a name other than that of the ground");
  const Formulation formulation = read_formulation(view);
  require_meaning(view, formulation);
  body.kind = formulation.kind;
  read_mass_and_inertia(view, body);
  if (view.has("position")) body.position = read_vector(view["position"]);
  if (view.has("orientation") || view.has("rotation")) body.orientation = read_orientation(view);
  if (view.has("velocity")) body.velocity = read_vector(view["velocity"]);
  if (view.has("angular_velocity")) body.angular_velocity = read_vector(view["angular_velocity"]);
  if (view.has("gyroscopic")) body.gyroscopic = view["gyroscopic"].boolean();
  if (has_fixed_point(body.kind)) {
    view.require_key("fixed_point");
    body.fixed_point = read_vector(view["fixed_point"]);
    const Eigen::Matrix3d R = rotation_matrix<double>(Quaternion<double>(body.orientation));
    const Eigen::Vector3d arm = R.transpose() * (body.position - body.fixed_point);
    body.velocity = R * body.angular_velocity.cross(arm);
  }
  return body;
}

}  // namespace liebench
