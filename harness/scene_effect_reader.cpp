#include <fmt/format.h>

#include <array>
#include <stdexcept>

#include "groups/decimal.h"
#include "groups/quaternion.h"
#include "harness/errors.h"
#include "harness/scene_parts.h"

namespace liebench {

namespace {

constexpr std::size_t most_placed_effects = 1'000'000;

// An entry of "effects" of which nothing but the keys is known, and what it may refer to.
struct EffectSource {
  const JsonView& json;
  const SceneDescription& scene;
  const SceneNames& bodies;
  const SceneNames& joints;
  SceneEffects<double>& effects;  // where it goes

  const BodyDescription& body(int index) const { return scene.bodies[std::size_t(index)]; }
  bool has(const char* key) const { return json.has(key); }
  JsonView operator[](const char* key) const { return json[key]; }
  double not_negative_or_zero(const char* key) const { return has(key) ? read_not_negative(json[key]) : 0.0; }

  template <template <class> class Effect>
  void add(int a, int b, const Effect<double>& effect) const {
    const std::size_t count = std::apply([](const auto&... lists) { return (lists.size() + ...); }, effects);
    if (count >= most_placed_effects)
      json.reject(fmt::format("at most {} effects, counted once for each body or pair", most_placed_effects));
    std::get<std::vector<Placed<Effect<double>>>>(effects).push_back({effect, a, b});
  }
};

// The bodies of a list, each once; without one, all.
std::vector<int> read_bodies_or_all(const EffectSource& source) {
  std::vector<int> list;
  if (!source.has("bodies")) {
    for (std::size_t i = 0; i < source.scene.bodies.size(); ++i) list.push_back(int(i));
    return list;
  }
  const JsonView view = source["bodies"];
  view.require_array();
  std::vector<bool> found(source.scene.bodies.size());
  for (std::size_t i = 0; i < view.size(); ++i) {
    const int body = source.bodies.find(view[i]);
    if (found[std::size_t(body)]) view[i].reject("each body once");
    found[std::size_t(body)] = true;
    list.push_back(body);
  }
  return list;
}

const JointDescription& read_joint_of(const EffectSource& source, std::initializer_list<JointKind> kinds,
                                      std::string_view allowed) {
  const JointDescription& joint = source.scene.joints[std::size_t(source.joints.find(source["joint"]))];
  for (const JointKind kind : kinds)
    if (joint.kind == kind) return joint;
  source["joint"].reject(allowed);
}

const JointDescription& read_revolute(const EffectSource& source) {
  return read_joint_of(source, {JointKind::revolute}, "the name of a revolute joint");
}

JointAngle<double> angle_of(const JointDescription& joint) {
  return {joint.axis_a, joint.across_a, joint.across_b};
}

void read_uniform_gravity(const EffectSource& source) {
  const Eigen::Vector3d acceleration = read_vector(source["acceleration"]);
  for (const int body : read_bodies_or_all(source))
    source.add(body, -1, UniformGravity<double>{source.body(body).mass, acceleration});
}

void read_point_gravity(const EffectSource& source) {
  const double parameter = read_positive(source["gravitational_parameter"]);
  const Eigen::Vector3d center =
      source.has("center") ? read_vector(source["center"]) : Eigen::Vector3d::Zero();
  for (const int index : read_bodies_or_all(source)) {
    const BodyDescription& body = source.body(index);
    if (!((body.position - center).stableNorm() >= smallest_scene_number))
      source.json.reject(fmt::format("a center apart from all bodies; \"{}\" is there", body.name));
    const Eigen::Matrix3d inertia =
        body.kind == BodyKind::r3 ? Eigen::Matrix3d(Eigen::Matrix3d::Zero()) : body.inertia;
    source.add(index, -1, PointGravity<double>{parameter, center, body.mass, inertia});
  }
}

void read_spring_damper(const EffectSource& source) {
  const BodyPair pair = read_body_pair(source["bodies"], source.bodies);
  const JsonView points = source["points"];
  const PointPair ends = read_point_pair(source.json, source.scene, pair);
  const double present = initial_distance(source.scene, pair, ends);
  if (!(present >= smallest_scene_number))
    points.reject("two points apart: a spring without a length has no direction");
  source.add(
      pair.a, pair.b,
      SpringDamper<double>{ends.a, ends.b, read_not_negative(source["stiffness"]),
                           source.not_negative_or_zero("damping"),
                           source.has("rest_length") ? read_not_negative(source["rest_length"]) : present});
}

void read_torsional_spring(const EffectSource& source) {
  const JointDescription& joint = read_revolute(source);
  source.add(joint.a, joint.b,
             TorsionalSpring<double>{angle_of(joint), read_not_negative(source["stiffness"]),
                                     source.not_negative_or_zero("damping"),
                                     source.has("rest_angle") ? read_number(source["rest_angle"]) : 0.0});
}

// The axes of the bushing are those of the inertial frame at the initial poses.
void read_bushing(const EffectSource& source) {
  const BodyPair pair = read_body_pair(source["bodies"], source.bodies);
  for (const int body : {pair.a, pair.b})
    if (body >= 0 && source.body(body).kind == BodyKind::r3)
      source["bodies"].reject("bodies that can turn, not a point mass (R3)");
  const PointPair points = read_point_pair(source.json, source.scene, pair);
  const auto axes = [&](int body) {
    const InitialFrame frame(source.scene, body);
    Eigen::Matrix3d columns;
    for (Eigen::Index i = 0; i < 3; ++i)
      columns.col(i) = rounded(frame.turn_to_body(InitialFrame::Vector::Unit(i)));
    return columns;
  };
  const auto vector = [&](const char* key) {
    return source.has(key) ? read_not_negative_vector(source[key]) : Eigen::Vector3d(Eigen::Vector3d::Zero());
  };
  source.add(
      pair.a, pair.b,
      Bushing<double>{points.a, axes(pair.a), points.b, axes(pair.b), vector("stiffness"), vector("damping"),
                      vector("rotational_stiffness"), vector("rotational_damping")});
}

void read_drag(const EffectSource& source) {
  const Drag<double> drag{source.not_negative_or_zero("linear"), source.not_negative_or_zero("quadratic"),
                          source.not_negative_or_zero("angular_linear"),
                          source.not_negative_or_zero("angular_quadratic")};
  for (const int body : read_bodies_or_all(source)) source.add(body, -1, drag);
}

TimeFunction<double> read_table(const JsonView& view) {
  constexpr std::string_view allowed = "a list of pairs [time, factor]";
  if (!view.is_array() || view.size() == 0) view.reject(allowed);
  std::vector<double> times, values;
  for (std::size_t i = 0; i < view.size(); ++i) {
    const JsonView pair = view[i];
    require_count(pair, 2, "a pair [time, factor]");
    times.push_back(read_number(pair[0]));
    values.push_back(read_number(pair[1]));
    if (i > 0 && !(times[i - 1] < times[i]))
      pair[0].reject(fmt::format("a time after the one before it, {} s", times[i - 1]));
  }
  return TimeFunction<double>::table(times, values);
}

TimeFunction<double> read_expression(const JsonView& view) {
  constexpr std::size_t longest = 1000;
  const std::string text = view.text();
  if (text.empty() || text.size() > longest)
    view.reject(fmt::format("an expression of t of 1 to {} characters", longest));
  try {
    return TimeFunction<double>::expression(text);
  } catch (const std::invalid_argument& error) {
    throw InputError(
        view.pointer(),
        fmt::format("{}; allowed: an expression of the time t in s, like \"sin(2*t)\"", error.what()));
  }
}

TimeFunction<double> read_factor(const JsonView& view) {
  if (view.value().is_number()) return TimeFunction<double>::constant(read_number(view));
  if (!view.value().is_object())
    view.reject("a number, {\"table\": [[t, f], ...]} or {\"expression\": \"...\"}");
  view.require_object({"table", "expression"});
  require_one_of(view, {"table", "expression"});
  return view.has("table") ? read_table(view["table"]) : read_expression(view["expression"]);
}

void read_applied_force(const EffectSource& source) {
  const auto vector = [&](const char* key) {
    return source.has(key) ? read_vector(source[key]) : Eigen::Vector3d(Eigen::Vector3d::Zero());
  };
  const int body = source.bodies.find(source["body"]);
  if (!source.has("force") && !source.has("torque"))
    source.json.reject("an object with the keys \"force\", \"torque\" or both");
  if (source.body(body).kind == BodyKind::r3)
    for (const char* key : {"torque", "point"})
      if (source.has(key)) source[key].reject("none: the body is a point mass (R3)");
  const bool body_frame =
      source.has("frame") && source["frame"].word({"inertial", "body"}, "frame") == "body";
  source.add(body, -1,
             AppliedForce<double>{
                 vector("force"), vector("torque"), vector("point"),
                 body_frame ? ForceFrame::body : ForceFrame::inertial,
                 source.has("factor") ? read_factor(source["factor"]) : TimeFunction<double>::constant(1.0)});
}

void read_motor(const EffectSource& source) {
  const JointDescription& joint = read_revolute(source);
  Motor<double> motor{angle_of(joint),
                      read_motion(source["target"]),
                      source.not_negative_or_zero("kp"),
                      source.not_negative_or_zero("kd"),
                      {}};
  if (source.has("limit")) motor.torque_limit = read_positive(source["limit"]);
  source.add(joint.a, joint.b, motor);
}

void read_joint_friction(const EffectSource& source) {
  const JointDescription& joint = read_joint_of(source, {JointKind::revolute, JointKind::prismatic},
                                                "the name of a revolute or prismatic joint");
  const bool turns = joint.kind == JointKind::revolute;
  const char* right = turns ? "torque" : "force";
  const char* wrong = turns ? "force" : "torque";
  if (source.has(wrong)) source[wrong].reject(fmt::format("none: this joint takes \"{}\"", right));
  source.json.require_key(right);
  const double size = read_not_negative(source[right]), scale = read_positive(source["slip_velocity"]);
  if (turns)
    source.add(joint.a, joint.b, RevoluteFriction<double>{joint.axis_a, size, scale});
  else
    source.add(joint.a, joint.b, PrismaticFriction<double>{joint.axis_a, joint.point_b, size, scale});
}

void read_contact(const EffectSource& source) {
  const JsonView plane = source["plane"];
  plane.require_object({"point", "normal"});
  plane.require_key("normal");
  const double exponent = source.has("exponent") ? source["exponent"].number("1 or 1.5") : 1.0;
  if (exponent != 1.0 && exponent != 1.5) source["exponent"].reject("1 or 1.5");
  const double friction = source.not_negative_or_zero("friction");
  if (friction > 0.0) source.json.require_key("slip_velocity");
  source.add(
      source.bodies.find(source["body"]), -1,
      Contact<double>{
          source.has("center") ? read_vector(source["center"]) : Eigen::Vector3d(Eigen::Vector3d::Zero()),
          read_not_negative(source["radius"]),
          plane.has("point") ? read_vector(plane["point"]) : Eigen::Vector3d(Eigen::Vector3d::Zero()),
          read_direction(plane["normal"]).stableNormalized(),
          exponent == 1.5 ? ContactLaw::hertz : ContactLaw::linear, read_positive(source["stiffness"]),
          source.not_negative_or_zero("damping"), friction,
          source.has("slip_velocity") ? read_positive(source["slip_velocity"]) : 1.0});
}

struct EffectType {
  std::string_view name;
  std::vector<std::string> required, optional;
  void (*read)(const EffectSource& source);
};

// Every effect that acts: the explicit list.
const std::vector<EffectType>& effect_types() {
  static const std::vector<EffectType> list{
      {"uniform_gravity", {"acceleration"}, {"bodies"}, read_uniform_gravity},
      {"point_gravity", {"gravitational_parameter"}, {"center", "bodies"}, read_point_gravity},
      {"spring_damper", {"bodies", "points", "stiffness"}, {"damping", "rest_length"}, read_spring_damper},
      {"torsional_spring", {"joint", "stiffness"}, {"damping", "rest_angle"}, read_torsional_spring},
      {"bushing",
       {"bodies", "stiffness"},
       {"point", "points", "damping", "rotational_stiffness", "rotational_damping"},
       read_bushing},
      {"drag", {}, {"bodies", "linear", "quadratic", "angular_linear", "angular_quadratic"}, read_drag},
      {"applied_force", {"body"}, {"force", "torque", "point", "frame", "factor"}, read_applied_force},
      {"motor", {"joint", "target", "kp"}, {"kd", "limit"}, read_motor},
      {"joint_friction", {"joint", "slip_velocity"}, {"torque", "force"}, read_joint_friction},
      {"contact",
       {"body", "radius", "plane", "stiffness"},
       {"center", "exponent", "damping", "friction", "slip_velocity"},
       read_contact}};
  return list;
}

// On by nature: named to be switched off.
constexpr std::string_view gyroscopic_name = "gyroscopic";

void require_effect_keys(const JsonView& view, const std::vector<std::string>& required,
                         const std::vector<std::string>& optional) {
  std::vector<std::string> keys{"type", "name", "enabled"};
  keys.insert(keys.end(), required.begin(), required.end());
  keys.insert(keys.end(), optional.begin(), optional.end());
  view.require_object(keys);
  for (const std::string& key : required) view.require_key(key);
}

}  // namespace

void read_effect(const JsonView& view, const SceneNames& bodies, const SceneNames& joints,
                 SceneDescription& scene) {
  if (!view.value().is_object()) view.reject("an object with the key \"type\"");
  view.require_key("type");
  std::vector<std::string> names;
  for (const EffectType& type : effect_types()) names.emplace_back(type.name);
  names.emplace_back(gyroscopic_name);
  const std::string name = view["type"].word(names, "effect");
  const bool enabled = !view.has("enabled") || view["enabled"].boolean();
  // What is switched off is read as strictly, and thrown away.
  SceneEffects<double> nowhere;
  const EffectSource source{view, scene, bodies, joints, enabled ? scene.effects : nowhere};
  if (name == gyroscopic_name) {
    require_effect_keys(view, {}, {"bodies"});
    for (const int body : read_bodies_or_all(source)) {
      if (source.body(body).kind == BodyKind::r3 && view.has("bodies"))
        view["bodies"].reject("bodies that can turn, not a point mass (R3)");
      if (!enabled) scene.bodies[std::size_t(body)].gyroscopic = false;
    }
    return;
  }
  for (const EffectType& type : effect_types()) {
    if (type.name != name) continue;
    require_effect_keys(view, type.required, type.optional);
    type.read(source);
  }
}

}  // namespace liebench
