#pragma once

#include <string>
#include <vector>

#include "harness/embedded.h"
#include "harness/errors.h"
#include "harness/scene_reader.h"
#include "tests/harness/json_schema.h"

// A scene to change, and what the reader and the schema say about it.

namespace liebench {

inline constexpr const char* base_scene = R"({
  "name": "base",
  "bodies": [
    {"name": "crank", "mass": 2, "inertia": [1, 2, 2.5], "position": [1, 0, 0]},
    {"name": "rod", "shape": {"type": "rod", "length": 2, "width": 0.1, "density": 100}, "position": [2, 0, 0],
     "rotation": {"axis": [0, 0, 2], "angle": 1.5707963267948966}},
    {"name": "bead", "formulation": "R3", "mass": 0.5, "position": [3, 0, 0]}],
  "joints": [
    {"name": "hinge", "type": "revolute", "bodies": ["ground", "crank"], "point": [0, 0, 0], "axis": [0, 0, 1]},
    {"name": "guide", "type": "prismatic", "bodies": ["crank", "rod"], "point": [2, 0, 0], "axis": [1, 0, 0]}],
  "effects": [
    {"type": "uniform_gravity", "acceleration": [0, 0, -9.81]},
    {"type": "spring_damper", "bodies": ["ground", "bead"], "points": [[0, 0, 0], [0, 0, 0]], "stiffness": 10}]
})";

inline Json scene_json(const std::string& text) {
  return parse_json(text, "test");
}

// The base scene with the value at `pointer` replaced or added; an empty text removes the key there.
inline Json changed_scene(const std::string& pointer, const std::string& value) {
  Json scene = scene_json(base_scene);
  const Json::json_pointer place(pointer);
  if (value.empty())
    scene[place.parent_pointer()].erase(place.back());
  else
    scene[place] = scene_json(value);
  return scene;
}

// With another effect or joint at the end of its list.
inline Json scene_with(const char* list, const std::string& entry) {
  Json scene = scene_json(base_scene);
  scene[list].push_back(scene_json(entry));
  return scene;
}
inline Json with_effect(const std::string& entry) {
  return scene_with("effects", entry);
}
inline Json with_joint(const std::string& entry) {
  return scene_with("joints", entry);
}

inline std::string scene_error(const Json& scene) {
  try {
    read_scene(scene);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

template <template <class> class Effect>
const std::vector<Placed<Effect<double>>>& effects_of(const SceneDescription& scene) {
  return std::get<std::vector<Placed<Effect<double>>>>(scene.effects);
}

inline std::size_t effect_count(const SceneDescription& scene) {
  return std::apply([](const auto&... lists) { return (lists.size() + ...); }, scene.effects);
}

inline const JsonSchema& scene_schema() {
  static const JsonSchema schema(embedded_file("scene.schema.json"));
  return schema;
}

}  // namespace liebench
