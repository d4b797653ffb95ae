#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "harness/strict_json.h"
#include "problems/scene_description.h"

// A scene from JSON (docs/scenes.md, harness/scene.schema.json): read strictly, and checked as a whole before anything runs.

namespace liebench {

// A chain of 10,000 bodies takes 5 MB.
inline constexpr std::uintmax_t largest_scene_file = 64u << 20;  // bytes

// Throws InputError with the JSON pointer of the first thing that is wrong. `where`: the pointer of the scene itself.
SceneDescription read_scene(const Json& scene, const std::string& where = "");

// Before the name of a scene that is compiled into the program.
inline constexpr std::string_view builtin_prefix = "builtin:";

// Of a file, or of one of the scenes that are compiled into the program: "builtin:bricard". The place of an InputError is the
// file with the pointer behind "#": "top.json#/bodies/0/mass".
SceneDescription read_scene_file(const std::filesystem::path& file);
// Its JSON, not yet checked.
Json read_scene_json(const std::filesystem::path& file);
// "builtin:andrews_squeezer", ..., as read_scene_json takes them.
std::vector<std::string> builtin_scenes();

}  // namespace liebench
