#include "harness/stability/case.h"

#include "harness/stability/cases/cases.h"

namespace liebench {

std::string_view name(Grade grade) {
  switch (grade) {
    case Grade::survived:
      return "survived";
    case Grade::degraded:
      return "degraded";
    case Grade::failed:
      break;
  }
  return "failed";
}

std::string_view name(Verdict verdict) {
  switch (verdict) {
    case Verdict::passed:
      return "passed";
    case Verdict::degraded:
      return "degraded";
    case Verdict::failed_as_expected:
      return "failed_as_expected";
    case Verdict::failed_unexpectedly:
      return "failed_unexpectedly";
    case Verdict::passed_unexpectedly:
      break;
  }
  return "passed_unexpectedly";
}

Verdict verdict(Grade found, Grade expected, Grade at_worst) {
  if (found > at_worst) return Verdict::failed_unexpectedly;
  if (found < expected) return Verdict::passed_unexpectedly;
  return found == Grade::survived   ? Verdict::passed
         : found == Grade::degraded ? Verdict::degraded
                                    : Verdict::failed_as_expected;
}

bool surprise(Verdict v) {
  return v == Verdict::failed_unexpectedly || v == Verdict::passed_unexpectedly;
}

Verdict worst(Verdict a, Verdict b) {
  const auto rank = [](Verdict v) {
    switch (v) {
      case Verdict::passed:
        return 0;
      case Verdict::degraded:
        return 1;
      case Verdict::failed_as_expected:
        return 2;
      case Verdict::passed_unexpectedly:
        return 3;
      case Verdict::failed_unexpectedly:
        break;
    }
    return 4;
  };
  return rank(a) < rank(b) ? b : a;
}

void add_trials(std::vector<Trial>& trials, const std::vector<std::string>& forms, const TrialMaker& make) {
  for (const bool safeguard : {true, false})
    for (const Contestant& contestant : contestants(safeguard)) {
      // A method without the option is there once.
      if (!safeguard && !contestant.can_be_safeguarded()) continue;
      for (const std::string& form : forms) {
        if (!fits(contestant.method->fits, !form.empty())) continue;
        if (!form.empty() && !has_option(*contestant.method, "form") && form != contestant.own_form())
          continue;
        if (auto trial = make(contestant, form)) {
          // Of what takes long once is enough.
          if (!safeguard && !trial->quick) continue;
          if (trial->contestant == nullptr) trial->contestant = &contestant;
          trial->subject = contestant.name;
          trial->form = form;
          trials.push_back(std::move(*trial));
        }
      }
    }
}

bool weakly_unstable(const Contestant& method, const std::string& form) {
  return form == "index3" && method.rho_inf() == 1.0;
}

Finding finding_of(const SceneRunEnd& end) {
  Finding finding;
  finding.outcome = end.outcome;
  finding.failure = end.failure;
  finding.grade = end.outcome == Outcome::ok && end.finite ? Grade::survived : Grade::failed;
  if (end.outcome == Outcome::ok && !end.finite) finding.outcome = Outcome::non_finite;
  return finding;
}

const std::vector<StabilityCase>& stability_cases() {
  static const std::vector<StabilityCase> list{
      long_runs(),       small_steps(),  large_rotations(), extreme_arguments(),
      correction_term(), stiffness(),    singular(),        masses(),
      bad_beginnings(),  rough_forces(), unstable_motion(), degenerate_runs(),
  };
  return list;
}

}  // namespace liebench
