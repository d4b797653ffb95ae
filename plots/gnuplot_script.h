#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "plots/figure.h"

namespace liebench {

/// Throws std::invalid_argument as draw() does.
void require_drawable(const Figure& figure, std::span<const std::filesystem::path> outputs);

/// The script that draws `figure` into `outputs`, data included. Throws std::invalid_argument as draw() does.
std::string gnuplot_script(const Figure& figure, std::span<const std::filesystem::path> outputs);

/// The same, but each of `outputs`, whose endings choose the formats, is written to the file at its place in
/// `written_to`.
std::string gnuplot_script(const Figure& figure, std::span<const std::filesystem::path> outputs,
                           std::span<const std::filesystem::path> written_to);

/// The command that makes `output`, `width` by `height` points, by its ending. Throws std::invalid_argument for another one.
std::string terminal_commands(const std::filesystem::path& output, double width, double height);

}  // namespace liebench
