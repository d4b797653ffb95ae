#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <regex>
#include <set>
#include <string>
#include <type_traits>
#include <vector>

#include "harness/embedded.h"
#include "harness/errors.h"
#include "harness/execute.h"
#include "harness/listed_problem.h"
#include "harness/progress.h"
#include "harness/study.h"
#include "integrators/consistent_projection.h"
#include "integrators/erased_system.h"
#include "problems/list.h"
#include "tests/harness/json_schema.h"
#include "tests/support/run_program.h"

// What is listed (problems/list.h) is tested, and what is there is listed.

namespace liebench::problem_list_test {
namespace {

using System = RunTimeSystem<Extended>;
using Vector = System::Vector;

ParameterNumbers defaults(const ListedSystem& listed) {
  ParameterNumbers numbers;
  for (const ListedParameter& p : listed.parameters) numbers.push_back(p.fallback);
  return numbers;
}

TEST(ProblemList, HasEveryProblemThatAHeaderDefines) {
  const std::regex definition("static constexpr std::string_view name =\\s+\"([a-z0-9_]+)\"");
  std::set<std::string> defined, listed;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::filesystem::path(LIEBENCH_SOURCE_DIR) / "problems")) {
    if (!entry.is_regular_file()) continue;
    std::ifstream stream(entry.path());
    const std::string text{std::istreambuf_iterator<char>(stream), {}};
    for (std::sregex_iterator match(text.begin(), text.end(), definition), end; match != end; ++match)
      defined.insert((*match)[1]);
  }
  for (const ListedSystem& system : listed_systems()) listed.emplace(system.name);
  EXPECT_FALSE(listed.empty());
  EXPECT_EQ(defined, listed) << "a problem is in problems/ and not in problems/list.h";
}

TEST(ProblemList, HasProblemsWhoseFunctionsAgree) {
  for (const ListedSystem& system : listed_systems()) {
    const SystemCheck check = check_listed_system(system.name, defaults(system));
    EXPECT_TRUE(check.extended) << system.name;
    EXPECT_FALSE(check.laws.empty()) << system.name;
    for (const LawCheck& law : check.laws) EXPECT_TRUE(law.holds) << system.name << ": " << message(law);
  }
}

// The fastest rate of the motion where it begins, 1/s: that of turning, and of growth, decay and swing as the derivatives of v' by v and
// by q have it.
double fastest_rate(const System& system) {
  const Vector q = system.initial_configuration(), v = system.initial_velocity();
  NoAudit audit;
  const auto acceleration = [&](const Vector& at, const Vector& velocity) {
    const auto dynamics = consistent_dynamics(system, Extended(0.0), at, velocity, audit);
    EXPECT_TRUE(dynamics.has_value());
    return dynamics ? dynamics->acceleration : zero_velocity(system);
  };
  constexpr double step = 1e-10;
  double rate = to_double(system.group().rotation_angle(v));
  const Vector here = acceleration(q, v);
  for (Eigen::Index j = 0; j < v.size(); ++j) {
    Vector w = zero_velocity(system);
    w(j) = Extended(step);
    const auto slope = [&](const Vector& moved) { return to_double(Extended((moved - here).norm())) / step; };
    rate = std::max(rate, slope(acceleration(q, v + w)));
    rate =
        std::max(rate, std::sqrt(slope(acceleration(system.group().compose(q, system.group().exp(w)), v))));
  }
  return rate;
}

// Some methods, one of each kind and order up to 4, in extended precision over the time 1 / rate in 64 and 128 steps: an error C h^p (1 + c h)
// falls as an order of p + 0.011 c / rate.
TEST(ProblemList, HasProblemsOnWhichMethodsKeepTheirOrders) {
  const TemporaryFolder cache;
  const JsonSchema study_schema(embedded_file("study.schema.json")),
      record_schema(embedded_file("record.schema.json"));
  for (const ListedSystem& listed : listed_systems()) {
    const double length = 1.0 / fastest_rate(listed.make(defaults(listed))->extended());
    ASSERT_TRUE(std::isfinite(length)) << listed.name;
    const std::string only_free = listed.constraints == 0
                                      ? R"(, {"name": "rkmk"}, {"name": "commutator_free"})"
                                      : R"(, {"name": "half_explicit"})";
    const std::string text = fmt::format(
        R"({{"name": "list", "problems": [{{"name": "{}"}}], "integrators": [{{"name": "bliedf2nd", "k": [2, 3, 4]}},
            {{"name": "generalized_alpha"}}, {{"name": "rattlie"}}{}], "step_sizes": [{}, {}], "t_end": {},
            "precision": ["double", "extended"]}})",
        listed.name, only_free, length / 64.0, length / 128.0, length);
    EXPECT_EQ(study_schema.violations(text), "") << text;
    const Study study = read_study(parse_json(text, "study"));
    std::vector<Json> records(study.runs.size());
    Progress progress("", 1.0);
    execute(study.runs, 2, ReferenceCache(cache.path()), progress,
            [&](std::size_t i, const Json& record) { records[i] = record; });
    std::map<std::string, std::vector<double>> errors;
    for (std::size_t i = 0; i < records.size(); ++i) {
      const Json& record = records[i];
      EXPECT_EQ(record_schema.violations(record.dump()), "") << record;
      ASSERT_EQ(record.at("outcome"), "ok") << record;
      EXPECT_LE(record.at("reference").at("error_estimate").get<double>(), 1e-16) << listed.name;
      if (record.at("precision") == "double") {
        EXPECT_GT(record.at("cost").at("flops").get<std::uint64_t>(), 0u) << record;
        continue;
      }
      const ConvergenceOrders expected = study.runs[i].method->orders(study.runs[i].request.options);
      const std::string method = study.runs[i].method->title(study.runs[i].request.options);
      const auto take = [&](const char* component, int order) {
        std::vector<double>& list = errors[method + component];
        list.push_back(record.at("errors").at(component).at("end_absolute").get<double>());
        if (list.size() == 2) {
          EXPECT_NEAR(std::log2(list[0] / list[1]), order, 0.2)
              << listed.name << ", " << method << ", " << component << ": " << list[0] << ", " << list[1];
        }
      };
      take("q", expected.q);
      take("v", expected.v);
      if (listed.constraints > 0) take("lambda", expected.lambda);
    }
    EXPECT_FALSE(errors.empty());
  }
}

// What the exact motion keeps its reference keeps, between its nodes too; it comes back from the cache bit by bit.
TEST(ListedProblem, HasAReferenceThatKeepsItsEnergyAndComesBackFromItsBytes) {
  const ListedSystem& listed = listed_systems().front();
  const auto instance = listed.make(defaults(listed));
  const System system = instance->extended();
  const double duration = 2000.0;
  IntegratedReference::Options options;
  options.separation = [&](const Vector& q, const Vector& p) { return instance->separation(q, p); };
  const IntegratedReference reference(system, duration, options);
  EXPECT_LE(reference.error_estimate(), 1e-17);
  EXPECT_EQ(reference.agreement_time(), duration);
  const Vector v0 = system.initial_velocity();
  const Extended kinetic = v0.dot(system.momentum(system.initial_configuration(), v0)) * 0.5;
  const Extended initial = system.energy(system.initial_configuration(), v0);
  const auto restored = IntegratedReference::restored(system, duration, reference.payload());
  ASSERT_TRUE(restored.has_value());
  EXPECT_EQ(restored->error_estimate(), reference.error_estimate());
  EXPECT_EQ(restored->method(), reference.method());
  for (const double t : {0.0, 0.3, 1.0, 777.7, 1234.5678, 1999.9, 2000.0}) {
    const auto point = reference.at(Extended(t)), again = restored->at(Extended(t));
    EXPECT_EQ(point.q, again.q) << t;
    EXPECT_EQ(point.v, again.v) << t;
    const double drift = to_double((system.energy(point.q, point.v) - initial) / kinetic);
    EXPECT_LE(std::abs(drift), 1e-15) << t;
  }
  const std::string bytes = reference.payload();
  EXPECT_FALSE(IntegratedReference::restored(system, duration, bytes.substr(0, bytes.size() - 8)));
  EXPECT_FALSE(IntegratedReference::restored(system, duration, bytes + std::string(8, '\0')));
  EXPECT_FALSE(IntegratedReference::restored(system, duration, ""));
}

// An edit of the header: the torque of the gravity gradient with a factor that is off by 1e-6, and another zero of the energy.
template <class T>
class EditedForce : public OrbitingGyrostat<T> {
 public:
  using OrbitingGyrostat<T>::OrbitingGyrostat;
  explicit EditedForce(const OrbitingGyrostat<T>& other) : OrbitingGyrostat<T>(other) {}
  template <class U>
  using rebind = EditedForce<U>;
  template <class U>
  EditedForce<U> cast() const {
    return EditedForce<U>(OrbitingGyrostat<T>::template cast<U>());
  }
  typename OrbitingGyrostat<T>::Vector force(const T& t, const typename OrbitingGyrostat<T>::Matrix& R,
                                             const typename OrbitingGyrostat<T>::Vector& omega) const {
    return OrbitingGyrostat<T>::force(t, R, omega) * T(1.000001);
  }
};

TEST(ListedProblem, HasAFingerprintThatChangesWithItsEquationsAndParameters) {
  const auto of = [](const auto& system) {
    using S = std::remove_cvref_t<decltype(system)>;
    return fingerprint(System(std::make_shared<ErasedSystem<S>>(system)));
  };
  OrbitingGyrostatParameters parameters;
  const std::string plain = of(OrbitingGyrostat<Extended>(parameters));
  EXPECT_EQ(of(OrbitingGyrostat<Extended>(parameters)), plain);
  EXPECT_NE(of(EditedForce<Extended>(parameters)), plain);
  parameters.wheel_momentum[2] += 1e-6;
  EXPECT_NE(of(OrbitingGyrostat<Extended>(parameters)), plain);

  const auto key = [](const std::string& wheel) {
    const Json study = parse_json(
        R"({"name": "s", "problems": [{"name": "orbiting_gyrostat", "parameters": {"wheel_momentum": )" +
            wheel + R"(}}], "integrators": [{"name": "rkmk"}], "step_sizes": [10], "t_end": 100})",
        "study");
    const RunSpec run = read_study(study).runs.at(0);
    EXPECT_EQ(run.canonical_input().at("fingerprint"), run.problem->fingerprint(run.parameters));
    return run.key();
  };
  EXPECT_EQ(key("[0, 0.002, 0.01]"), key("[0.0, 2e-3, 1e-2]"));
  EXPECT_NE(key("[0, 0.002, 0.01]"), key("[0, 0.002, 0.02]"));
}

TEST(ListedProblem, SaysWhatItsParametersTake) {
  const ProblemInfo info = listed_problem(listed_systems().front());
  EXPECT_EQ(info.name, "orbiting_gyrostat");
  ASSERT_EQ(info.parameters.size(), 5u);
  EXPECT_EQ(info.parameters[0].shape, "a list of 3 numbers from 1e-06 to 1000000");
  EXPECT_EQ(info.parameters[0].fallback, Json({4.0, 11.0, 13.0}));
  EXPECT_EQ(info.parameters[1].shape, "a number from 0 to 1");
  EXPECT_EQ(info.parameters[1].unit, "rad/s");
  EXPECT_EQ(info.parameters[2].shape, "a list of 3 finite numbers");
}

TEST(ListedProblem, RefusesParametersWithTheirPlaceAndWhatIsAllowed) {
  const auto refusal = [](const char* parameters) -> std::string {
    const std::string study = R"({"name": "s", "problems": [{"name": "orbiting_gyrostat", "parameters": )" +
                              std::string(parameters) +
                              R"(}], "integrators": [{"name": "rkmk"}], "step_sizes": [10], "t_end": 100})";
    try {
      read_study(parse_json(study, "study"));
      return {};
    } catch (const InputError& error) {
      return error.what();
    }
  };
  const std::string at = "/problems/0/parameters/";
  EXPECT_EQ(refusal("{}"), "");
  EXPECT_EQ(refusal(R"({"orbital_rate": [0.001, 0.002]})"), "");
  EXPECT_EQ(refusal(R"({"orbital_rate": -1})"),
            at + "orbital_rate: -1 is not allowed here; allowed: a number from 0 to 1");
  EXPECT_EQ(refusal(R"({"orbital_rate": [0.1, 2]})"),
            at + "orbital_rate/1: 2 is not allowed here; allowed: a number from 0 to 1");
  EXPECT_EQ(refusal(R"({"orbital_rate": "fast"})"),
            at + "orbital_rate: \"fast\" is not allowed here; allowed: a number from 0 to 1");
  EXPECT_EQ(refusal(R"({"inertia": [1, 2]})"),
            at + "inertia: [1,2] is not allowed here; allowed: a list of 3 numbers from 1e-06 to 1000000");
  EXPECT_EQ(refusal(R"({"inertia": [1, 2, 0]})"),
            at + "inertia/2: 0 is not allowed here; allowed: a number from 1e-06 to 1000000");
  EXPECT_EQ(refusal(R"({"inertia": [1, 2, 5]})"),
            at + "inertia: [1.0,2.0,5.0] is not allowed here; allowed: moments none of which exceeds the sum "
                 "of the others");
  EXPECT_EQ(
      refusal(R"({"orientation": [0, 0, 0, 0]})"),
      at + "orientation: [0.0,0.0,0.0,0.0] is not allowed here; allowed: 4 numbers that are not all zero");
  EXPECT_EQ(refusal(R"({"wheel_momentum": 3})"),
            at + "wheel_momentum: 3 is not allowed here; allowed: a list of 3 finite numbers");
  EXPECT_NE(refusal(R"({"inertias": [1, 2, 3]})").find("did you mean \"inertia\"?"), std::string::npos);
}

// Solvers from outside know the heavy top and scenes, in whatever formulation another problem is.
TEST(ListedProblem, IsNotForSolversFromOutside) {
  for (const MethodInfo& method : methods())
    if (method.outside != nullptr) {
      EXPECT_NE(misfit(method, "orbiting_gyrostat", false, "S3"), "") << method.name;
    }
}

}  // namespace
}  // namespace liebench::problem_list_test
