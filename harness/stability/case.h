#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "harness/run.h"
#include "harness/stability/contestant.h"
#include "harness/stability/scene_run.h"
#include "harness/strict_json.h"

// A hard case: what it runs each method through, and what theory says of the outcome. One file a case in harness/stability/cases;
// the derivations are in docs/stability.md.

namespace liebench {

// What became of a run, by the criterion of its case; and what theory lets expect.
enum class Grade { survived, degraded, failed };
std::string_view name(Grade grade);

// Both together.
enum class Verdict {
  passed,               // survived, as expected
  degraded,             // less than survived, by no more than expected
  failed_as_expected,   // failed, as theory says it must
  failed_unexpectedly,  // worse than expected
  passed_unexpectedly,  // better than expected: the theory, or the case, is wrong
};
std::string_view name(Verdict verdict);
Verdict verdict(Grade found, Grade expected, Grade at_worst);
// Of several trials the one that a user must know first.
Verdict worst(Verdict a, Verdict b);
bool surprise(Verdict verdict);

struct Finding {
  Grade grade = Grade::failed;
  Grade expected = Grade::survived;
  // Theory promises nothing better than this, where it is worse than `expected`: what lies between is no surprise.
  std::optional<Grade> at_worst;
  // How far from what survives, in the unit that `what` names: a factor of energy, an error, ...; absent where the run ended early.
  std::optional<double> amount;
  std::string what;
  // Of two degraded trials the one with the larger severity is told of; the amount where it is not said.
  std::optional<double> severity;
  std::string reason;  // why `expected`
  Outcome outcome = Outcome::ok;
  std::optional<RunFailure> failure;
  std::map<std::string, double> measured;  // finite numbers
};

// One run of a case: a line of its record.
struct Trial {
  std::string variant;                     // "stiffness 1e6 N m/rad, undamped"
  std::string form;                        // "index3", "stabilized_index2", or empty: no constraints
  const Contestant* contestant = nullptr;  // null where it is a group that is tried
  std::string subject;                     // the row: the contestant's name, or the group's
  bool modified_start = true;              // the option, where it means something
  Json parameters = Json::object();        // what sets it apart, for its key
  double work = 1.0;                       // about so many thousand steps
  bool quick = true;                       // of the fast half
  std::function<Finding()> run;
};

struct StabilityCase {
  std::string_view name, title;
  std::string_view question;  // what it asks of a method
  std::string_view criterion;
  std::string_view
      theory;  // why it expects what it expects; the section of docs/stability.md has the derivation
  std::vector<Trial> (*trials)();
};

// The trial of one method in one form, or nothing where it does not apply.
using TrialMaker = std::function<std::optional<Trial>(const Contestant&, const std::string& form)>;
// The maker may name another contestant, of other options: the row is that of the one it got.
// Adds one trial for each contestant, with the safeguard and, where it is quick, without, and each of the forms.
void add_trials(std::vector<Trial>& trials, const std::vector<std::string>& forms, const TrialMaker& make);
inline const std::vector<std::string> constrained_forms{"index3", "stabilized_index2"};
inline const std::vector<std::string> unconstrained{""};

// The index-3 form of generalized-alpha with rho_inf = 1: the multipliers have a double root -1 of modulus 1, and theory promises no
// convergence of them [Arnold & Bruels 2007].
bool weakly_unstable(const Contestant& method, const std::string& form);

// A finding that begins with how the run ended: failed, unless it ended well with finite numbers.
Finding finding_of(const SceneRunEnd& end);

// Every case: the explicit list.
const std::vector<StabilityCase>& stability_cases();

}  // namespace liebench
