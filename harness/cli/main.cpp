#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <new>

#include "harness/cli/commands.h"
#include "harness/errors.h"
#include "harness/provenance.h"
#include "harness/strict_json.h"
#include "plots/gnuplot.h"

// Exit status: 0 done, 1 a check found a difference, 2 bad input, 3 the machine failed.

namespace {

// CLI11 would only say that a command is missing.
void require_known_command(const CLI::App& app, int argc, char** argv) {
  using namespace liebench;
  if (argc < 2 || argv[1][0] == '-') return;
  std::vector<std::string> commands;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    commands.push_back(command->get_name());
  const std::string word = argv[1];
  if (std::find(commands.begin(), commands.end(), word) == commands.end())
    throw InputError("", fmt::format("unknown command \"{}\"; allowed: {}{}", word, quoted_list(commands),
                                     suggestion(word, commands)));
}

}  // namespace

int main(int argc, char** argv) {
  using namespace liebench;
  CLI::App app(
      "liebench: what accuracy costs when a mechanical system with large rotations is integrated in time.\n"
      "Results go to standard output or to the file named, messages to standard error.");
  app.name("liebench");
  app.require_subcommand(1);
  app.set_version_flag("--version", [] {
    const BuildInfo build = build_info();
    return fmt::format("liebench {} ({}{}, {})", build.version, build.commit.substr(0, 12),
                       build.dirty ? ", changed" : "", build.compiler);
  });
  app.footer(
      "Examples:\n"
      "  liebench figures --out reproduced                  the paper's Figures 1 to 4 with records and "
      "orders\n"
      "  liebench run study.json --out study.jsonl          run a study; resumes where it stopped\n"
      "  liebench table study.jsonl --kind orders           observed orders of convergence\n"
      "  liebench plot study.jsonl --out study.svg          convergence plot\n"
      "  liebench compare old.jsonl new.jsonl               what changed; status 1 if something did\n"
      "  liebench check-problem scene.json                  whether a problem's functions agree; 1 if not\n"
      "  liebench describe bliedf2nd                        what a method or problem is and takes\n"
      "Exit status: 0 done (numerical failures are data); 1 a check found a difference; 2 bad input;\n"
      "3 the machine failed (disk full, gnuplot missing).");
  int status = 0;
  add_figures(app, status);
  add_run(app, status);
  add_simulate(app, status);
  add_effects(app, status);
  add_stability(app, status);
  add_check_problem(app, status);
  add_table(app, status);
  add_plot(app, status);
  add_compare(app, status);
  add_list(app, status);
  add_describe(app, status);
  try {
    require_known_command(app, argc, argv);
    app.parse(argc, argv);
    if (std::fflush(stdout) != 0 || std::ferror(stdout)) throw MachineError("standard output: cannot write");
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  } catch (const InputError& error) {
    fmt::print(stderr, "liebench: {}\n", error.what());
    return 2;
  } catch (const MachineError& error) {
    fmt::print(stderr, "liebench: {}\n", error.what());
    return 3;
  } catch (const GnuplotMissing& error) {
    fmt::print(stderr, "liebench: {}\n", error.what());
    return 3;
  } catch (const std::bad_alloc&) {
    fmt::print(stderr, "liebench: out of memory\n");
    return 3;
  } catch (const std::exception& error) {
    fmt::print(stderr, "liebench: {}\n", error.what());
    return 3;
  }
  return status;
}
