#include <fmt/format.h>

#include <cstdio>
#include <map>

#include "harness/cli/commands.h"
#include "harness/errors.h"
#include "harness/execute.h"
#include "harness/progress.h"
#include "harness/record.h"
#include "harness/record_file.h"
#include "harness/study.h"
#include "harness/timing.h"

namespace liebench {

namespace {

struct RunOptions {
  std::string study;
  std::string out;
  int jobs = default_jobs();
  std::string shard = "1/1";
  bool no_timing = false;
};

struct Shard {
  std::size_t index = 1;
  std::size_t count = 1;
};

Shard parse_shard(const std::string& text) {
  Shard shard;
  int read = 0;
  if (text.find_first_not_of("0123456789/") != std::string::npos ||
      std::sscanf(text.c_str(), "%zu/%zu%n", &shard.index, &shard.count, &read) != 2 ||
      std::size_t(read) != text.size() || shard.index < 1 || shard.index > shard.count)
    throw InputError("--shard",
                     fmt::format("\"{}\" is not allowed; allowed: I/N with 1 <= I <= N, e.g. 2/8", text));
  return shard;
}

void summarise(const std::map<std::string, int>& outcomes, std::size_t skipped) {
  std::string text;
  for (const auto& [outcome, count] : outcomes)
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, outcome);
  if (text.empty()) text = "nothing to run";
  if (skipped > 0) text += fmt::format("; {} already there", skipped);
  fmt::print(stderr, "runs: {}\n", text);
}

// Times the runs whose records are there, ended well and hold no time yet.
template <class Record, class Take>
void add_times(const std::vector<RunSpec>& runs, const std::string& study, const Record& record,
               const Take& take) {
  std::vector<RunSpec> timed;
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    if (!is_timed(runs[i])) continue;
    const Json row = record(i);
    if (row.at("outcome") != "ok" || row.contains("time")) continue;
    timed.push_back(runs[i]);
    places.push_back(i);
  }
  Progress progress(study + ", times", double(timed.size()));
  std::size_t unsteady = 0;
  time_runs(timed, TimingRules{}, ReferenceCache(), progress, [&](std::size_t index, const RunTimes& times) {
    if (!times.steady) ++unsteady;
    take(places[index], with_time(record(places[index]), times));
  });
  if (unsteady > 0)
    progress.message(
        fmt::format("times: {} of {} runs are unsteady (marked in their records); is the machine quiet?",
                    unsteady, timed.size()));
}

void run(const RunOptions& options) {
  const Shard shard = parse_shard(options.shard);
  const Study study = read_study(read_json_file(options.study));
  std::vector<RunSpec> runs;
  std::vector<std::string> keys;
  for (std::size_t i = 0; i < study.runs.size(); ++i)
    if (i % shard.count == shard.index - 1) {
      runs.push_back(study.runs[i]);
      keys.push_back(study.runs[i].key());
    }
  std::unique_ptr<RecordFile> file;
  if (!options.out.empty()) file = std::make_unique<RecordFile>(options.out);
  std::vector<RunSpec> missing;
  for (std::size_t i = 0; i < runs.size(); ++i)
    if (!file || !file->has(keys[i])) missing.push_back(runs[i]);

  double work = 0.0;
  for (const RunSpec& spec : missing) work += expected_work(spec);
  std::map<std::string, int> outcomes;
  std::vector<std::string> lines(missing.size());
  {
    Progress progress(study.name, work);
    execute(missing, options.jobs, ReferenceCache(), progress, [&](std::size_t index, const Json& record) {
      ++outcomes[record.at("outcome").get<std::string>()];
      if (file)
        file->append(record);
      else
        lines[index] = record.dump();
    });
  }
  if (!options.no_timing) {
    if (file)
      add_times(
          runs, study.name, [&](std::size_t i) { return file->record(keys[i]); },
          [&](std::size_t, const Json& record) { file->append(record); });
    else
      add_times(
          runs, study.name, [&](std::size_t i) { return Json::parse(lines[i]); },
          [&](std::size_t i, const Json& record) { lines[i] = record.dump(); });
  }
  if (file) {
    file->sort(keys);
  } else {
    for (const std::string& line : lines) fmt::print("{}\n", line);
    if (std::fflush(stdout) != 0) throw MachineError("standard output: cannot write");
  }
  summarise(outcomes, runs.size() - missing.size());
}

}  // namespace

void add_run(CLI::App& app, int&) {
  CLI::App* command = app.add_subcommand(
      "run", "Run a study; rows that are already in the file are not run again, nor timed again");
  auto options = std::make_shared<RunOptions>();
  command->add_option("study", options->study, "the study, a JSON file (docs/studies.md)")
      ->required()
      ->type_name("STUDY.json");
  command->add_option("--out", options->out, "file of records, JSON Lines; standard output where absent")
      ->type_name("FILE.jsonl");
  command->add_option("--jobs", options->jobs, "runs at a time; the records do not depend on it")
      ->type_name("N")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  command->add_option("--shard", options->shard, "run every N-th row only, beginning with the I-th")
      ->type_name("I/N");
  command->add_flag("--no-timing", options->no_timing,
                    "leave out the timed runs: errors and counts alone, the same bytes every time");
  command->footer(
      "Examples:\n  liebench run harness/studies/figure4.json --out figure4.jsonl --jobs 2\n"
      "  liebench run study.json --out part2.jsonl --shard 2/8 --no-timing     one of eight machines\n"
      "A study killed half-way goes on where it stopped when the same command is given again. The runs in "
      "double\n"
      "that ended well are timed when all others are done, one at a time on one processor, whatever --jobs "
      "says.");
  command->callback([options] { run(*options); });
}

}  // namespace liebench
