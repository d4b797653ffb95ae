#pragma once

#include <string_view>

namespace liebench {

// The text of a file that the build compiled into the program (studies and schemas) by its file name; empty
// where there is none of this name.
std::string_view embedded_file(std::string_view name);

}  // namespace liebench
