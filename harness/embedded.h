#pragma once

#include <string_view>
#include <vector>

namespace liebench {

// The text of a file that the build compiled into the program (studies and schemas) by its file name; empty
// where there is none of this name.
std::string_view embedded_file(std::string_view name);
std::vector<std::string_view> embedded_file_names();

// The same of the scenes in problems/scenes.
std::string_view embedded_scene(std::string_view name);
std::vector<std::string_view> embedded_scene_names();

// The same of the integrators' sheets in integrators/sheets.
std::string_view embedded_sheet(std::string_view name);
std::vector<std::string_view> embedded_sheet_names();

}  // namespace liebench
