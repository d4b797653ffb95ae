#include "harness/stability/suite.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <mutex>
#include <numeric>
#include <thread>

#include "harness/errors.h"
#include "harness/progress.h"
#include "harness/provenance.h"
#include "harness/record.h"
#include "harness/study.h"

namespace liebench {

namespace {

Json input_of(const SuiteTrial& s) {
  Json j;
  j["numerical_version"] = numerical_version;
  j["stability_version"] = stability_version;
  j["case"] = s.owner->name;
  j["variant"] = s.trial.variant;
  j["parameters"] = s.trial.parameters;
  j["subject"] = s.trial.subject;
  j["form"] = s.trial.form;
  if (s.trial.contestant != nullptr) {
    j["integrator"] = s.trial.contestant->method->name;
    j["options"] = options_to_json(*s.trial.contestant->method,
                                   s.trial.contestant->options_for(s.trial.form, s.trial.modified_start));
  }
  return j;
}

}  // namespace

std::string SuiteTrial::key() const {
  const std::string text = input_of(*this).dump();
  const XXH128_hash_t hash = XXH3_128bits(text.data(), text.size());
  return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

std::vector<SuiteTrial> suite(const std::vector<std::string>& only, bool quick) {
  std::vector<std::string> names;
  for (const StabilityCase& entry : stability_cases()) names.emplace_back(entry.name);
  for (const std::string& name : only)
    if (std::find(names.begin(), names.end(), name) == names.end())
      throw InputError("--only", fmt::format("unknown case \"{}\"; allowed: {}{}", name, quoted_list(names),
                                             suggestion(name, names)));
  std::vector<SuiteTrial> all;
  for (const StabilityCase& entry : stability_cases()) {
    if (!only.empty() && std::find(only.begin(), only.end(), entry.name) == only.end()) continue;
    for (Trial& trial : entry.trials())
      if (trial.quick || !quick) all.push_back({&entry, std::move(trial)});
  }
  return all;
}

Json stability_record(const SuiteTrial& s, const Finding& finding, const Json& provenance) {
  Json j;
  j["schema"] = record_schema;
  j["key"] = s.key();
  j["case"] = s.owner->name;
  j["variant"] = s.trial.variant;
  j["subject"] = s.trial.subject;
  if (!s.trial.form.empty()) j["form"] = s.trial.form;
  if (s.trial.contestant != nullptr) {
    j["integrator"] = s.trial.contestant->method->name;
    j["options"] = options_to_json(*s.trial.contestant->method,
                                   s.trial.contestant->options_for(s.trial.form, s.trial.modified_start));
  }
  j["parameters"] = s.trial.parameters;
  j["outcome"] = name(finding.outcome);
  if (finding.failure) {
    Json& failure = j["failure"];
    // JSON has no infinity.
    if (std::isfinite(finding.failure->time)) failure["time"] = finding.failure->time;
    failure["step"] = finding.failure->step;
    if (std::isfinite(finding.failure->residual)) failure["residual"] = finding.failure->residual;
    failure["message"] = finding.failure->message;
  }
  j["grade"] = name(finding.grade);
  j["expected"] = name(finding.expected);
  if (finding.at_worst) j["at_worst"] = name(*finding.at_worst);
  j["verdict"] = name(verdict(finding.grade, finding.expected, finding.at_worst.value_or(finding.expected)));
  if (finding.amount && std::isfinite(*finding.amount)) j["amount"] = *finding.amount;
  if (finding.severity && std::isfinite(*finding.severity)) j["severity"] = *finding.severity;
  j["what"] = finding.what;
  j["reason"] = finding.reason;
  for (const auto& [key, value] : finding.measured)
    if (std::isfinite(value)) j["measured"][key] = value;
  j["provenance"] = provenance;
  return j;
}

void run_suite(const std::vector<SuiteTrial>& trials, int jobs, Progress& progress,
               const std::function<void(std::size_t, const Json&)>& take) {
  const Json origin = provenance();
  std::vector<std::size_t> order(trials.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return trials[a].trial.work > trials[b].trial.work; });
  std::atomic<std::size_t> next{0};
  std::mutex mutex;
  std::exception_ptr failure;
  const auto work = [&] {
    try {
      for (std::size_t i = next++; i < order.size(); i = next++) {
        const SuiteTrial& trial = trials[order[i]];
        const Json record = stability_record(trial, trial.trial.run(), origin);
        const std::lock_guard lock(mutex);
        take(order[i], record);
        progress.advance(trial.trial.work);
      }
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (!failure) failure = std::current_exception();
      next = order.size();
    }
  };
  std::vector<std::jthread> threads;
  for (int i = 1; i < jobs; ++i) threads.emplace_back(work);
  work();
  threads.clear();
  if (failure) std::rethrow_exception(failure);
}

}  // namespace liebench
