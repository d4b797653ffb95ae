#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace liebench {

/// Runs the script that draws into temporary files in the place of `outputs`, and gives them their names when all of them are
/// whole. Throws as draw() of a figure does.
void draw_files(std::span<const std::filesystem::path> outputs,
                const std::function<std::string(std::span<const std::filesystem::path>)>& script);

}  // namespace liebench
