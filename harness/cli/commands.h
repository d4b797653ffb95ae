#pragma once

#include <CLI/CLI.hpp>
#include <memory>

namespace liebench {

// One function a command: adds it to the program with its options, help and action. An action throws
// InputError or MachineError, or returns its exit status through `status`.
void add_figures(CLI::App& app, int& status);
void add_run(CLI::App& app, int& status);
void add_table(CLI::App& app, int& status);
void add_plot(CLI::App& app, int& status);
void add_compare(CLI::App& app, int& status);
void add_simulate(CLI::App& app, int& status);
void add_effects(CLI::App& app, int& status);
void add_list(CLI::App& app, int& status);
void add_describe(CLI::App& app, int& status);

}  // namespace liebench
