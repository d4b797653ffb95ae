#include "harness/scene_reader.h"

#include <fmt/format.h>

#include "harness/embedded.h"
#include "harness/errors.h"
#include "harness/scene_parts.h"

namespace liebench {

namespace {

// A list that may be left out or empty.
std::size_t list_size(const JsonView& scene, const char* key) {
  if (!scene.has(key)) return 0;
  if (!scene[key].is_array()) scene[key].reject("a list");
  return scene[key].size();
}

void read_joints(const JsonView& root, const SceneNames& bodies, SceneNames& joints,
                 SceneDescription& scene) {
  for (std::size_t i = 0; i < list_size(root, "joints"); ++i) {
    const JsonView view = root["joints"][i];
    JointDescription joint = read_joint(view, scene, bodies);
    // Two joints without names between the same bodies are told apart by their numbers.
    if (!view.has("name") && joints.has(joint.name)) joint.name += " #" + std::to_string(i + 1);
    joints.add(view.has("name") ? view["name"] : view, joint.name);
    scene.joints.push_back(std::move(joint));
  }
}

}  // namespace

SceneDescription read_scene(const Json& json, const std::string& where) {
  const JsonView root(json, where);
  root.require_object({"name", "summary", "duration", "chaotic", "bodies", "joints", "effects"});
  for (const char* key : {"name", "bodies"}) root.require_key(key);
  SceneDescription scene;
  scene.name = read_name(root["name"]);
  if (root.has("summary")) scene.summary = root["summary"].text();
  if (root.has("duration")) scene.duration = read_positive(root["duration"]);
  if (root.has("chaotic")) scene.chaotic = root["chaotic"].boolean();

  const JsonView list = root["bodies"];
  list.require_array();
  SceneNames bodies("body"), joints("joint"), effects("effect");
  for (std::size_t i = 0; i < list.size(); ++i) {
    BodyDescription body = read_body(list[i]);
    bodies.add(list[i]["name"], body.name);
    scene.bodies.push_back(std::move(body));
  }
  read_joints(root, bodies, joints, scene);
  for (std::size_t i = 0; i < list_size(root, "effects"); ++i) {
    const JsonView view = root["effects"][i];
    read_effect(view, bodies, joints, scene);
    if (view.has("name")) effects.add(view["name"], read_name(view["name"]));
  }
  return scene;
}

std::vector<std::string> builtin_scenes() {
  std::vector<std::string> names;
  for (const std::string_view name : embedded_scene_names())
    names.push_back(std::string(builtin_prefix) + std::string(name.substr(0, name.rfind('.'))));
  return names;
}

Json read_scene_json(const std::filesystem::path& file) {
  const std::string name = file.string();
  if (!name.starts_with(builtin_prefix)) return read_json_file(file, largest_scene_file);
  const std::string_view text = embedded_scene(name.substr(builtin_prefix.size()) + ".json");
  if (text.empty()) {
    const std::vector<std::string> names = builtin_scenes();
    throw InputError(name, fmt::format("no such scene; in the program are {}{}", quoted_list(names),
                                       suggestion(name, names)));
  }
  return parse_json(text, name);
}

SceneDescription read_scene_file(const std::filesystem::path& file) {
  const Json json = read_scene_json(file);
  try {
    return read_scene(json);
  } catch (const InputError& error) {
    throw InputError(file.string() + "#" + error.place(), error.message());
  }
}

}  // namespace liebench
