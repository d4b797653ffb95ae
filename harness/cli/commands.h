#pragma once

#include <CLI/CLI.hpp>
#include <cmath>
#include <memory>
#include <string>

namespace liebench {

// CLI11's own names the largest double as the end of its range, in 309 digits.
inline CLI::Validator positive_number() {
  return {[](const std::string& text) -> std::string {
            double value = 0;
            if (CLI::detail::lexical_cast(text, value) && value > 0 && std::isfinite(value)) return {};
            return "\"" + text + "\" is not allowed; allowed: a positive number";
          },
          "POSITIVE"};
}

// One function a command: adds it to the program with its options, help and action. An action throws
// InputError or MachineError, or returns its exit status through `status`.
void add_figures(CLI::App& app, int& status);
void add_run(CLI::App& app, int& status);
void add_check_problem(CLI::App& app, int& status);
void add_table(CLI::App& app, int& status);
void add_plot(CLI::App& app, int& status);
void add_compare(CLI::App& app, int& status);
void add_simulate(CLI::App& app, int& status);
void add_effects(CLI::App& app, int& status);
void add_stability(CLI::App& app, int& status);
void add_list(CLI::App& app, int& status);
void add_describe(CLI::App& app, int& status);

}  // namespace liebench
