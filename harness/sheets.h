#pragma once

#include <string>
#include <string_view>

#include "harness/methods.h"

// A sheet for each integrator: what only a person can say of it, from integrators/sheets/NAME.md, beside what the program knows: what it
// declares, and what a step costs.

namespace liebench {

struct MethodSheet {
  std::string definition;  // in formulas, indented lines
  std::string source;
  std::string use, avoid;
};

// The parts of a sheet: the definition, and paragraphs that begin with "Source: ", "Use it: " and "Not: ". Throws std::logic_error that
// names the file and the part where one is missing, or empty.
MethodSheet read_sheet(std::string_view text, std::string_view file);
// That of an integrator of the list.
MethodSheet sheet_of(const MethodInfo& method);

// The sheet in plain text.
std::string sheet_text(const MethodInfo& method);

// "symmetric", "Phi(q) = 0 and B(q) v = 0 hold in every step": what it declares, a sentence each; empty where nothing.
std::string declarations_text(const MethodInfo& method);

// All sheets as a page in Markdown, each with the costs of a step of its methods, counted on the heavy top: docs/integrators.md is this text.
std::string integrators_page();

}  // namespace liebench
