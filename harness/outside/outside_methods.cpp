#include "harness/outside/outside_methods.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "integrators/step_control.h"

namespace liebench {

namespace {

constexpr auto tolerance_alone = std::to_array<OptionInfo>({tolerance_option});

constexpr OptionInfo erk_order{.name = "order",
                               .kind = OptionKind::integer,
                               .fallback = 8,
                               .least = 2,
                               .most = 8,
                               .meaning =
                                   "of the table, ARKODE's own for it: 5 Cash-Karp 6(5,4), 6 Verner "
                                   "8(6,5), 8 (and 7) Fehlberg 13(8,7)"};
constexpr OptionInfo dirk_order{.name = "order",
                                .kind = OptionKind::integer,
                                .fallback = 5,
                                .least = 2,
                                .most = 5,
                                .meaning = "of the table, ARKODE's own for it: 5 ARK5(4)8L[2]SA"};
constexpr auto erk_options = std::to_array<OptionInfo>({erk_order, tolerance_option});
constexpr auto dirk_options = std::to_array<OptionInfo>({dirk_order, tolerance_option});

}  // namespace

const std::vector<OutsideMethod>& outside_methods() {
  static const std::vector<OutsideMethod> list{
      {.name = "cvode_bdf",
       .summary = "SUNDIALS CVODE: BDF of orders 1 to 5 on the unit quaternion, with projection",
       .fits = Fits::without_constraints,
       .formulation = "S3",
       .scenes = true,
       .options = tolerance_alone,
       .title = [](const OptionValues&) -> std::string { return "CVODE BDF"; },
       .orders = [](const OptionValues&) { return same_order(5); },
       .runs = outside::cvode_bdf_runs()},
      {.name = "cvode_adams",
       .summary = "SUNDIALS CVODE: Adams-Moulton of orders 1 to 12 on the quaternion, fixed-point iteration",
       .fits = Fits::without_constraints,
       .formulation = "S3",
       .scenes = true,
       .options = tolerance_alone,
       .title = [](const OptionValues&) -> std::string { return "CVODE Adams"; },
       .orders = [](const OptionValues&) { return same_order(12); },
       .runs = outside::cvode_adams_runs()},
      {.name = "arkode_erk",
       .summary = "SUNDIALS ARKODE: explicit Runge-Kutta method on the quaternion",
       .fits = Fits::without_constraints,
       .formulation = "S3",
       .scenes = true,
       .options = erk_options,
       .title = [](const OptionValues& o) { return fmt::format("ARKODE ERK, order {}", o.integer("order")); },
       .orders =
           [](const OptionValues& o) { return same_order(o.integer("order") == 7 ? 8 : o.integer("order")); },
       .runs = outside::arkode_erk_runs()},
      {.name = "arkode_dirk",
       .summary = "SUNDIALS ARKODE: diagonally implicit Runge-Kutta method on the quaternion",
       .fits = Fits::without_constraints,
       .formulation = "S3",
       .scenes = true,
       .options = dirk_options,
       .title =
           [](const OptionValues& o) { return fmt::format("ARKODE DIRK, order {}", o.integer("order")); },
       .orders = [](const OptionValues& o) { return same_order(o.integer("order")); },
       .runs = outside::arkode_dirk_runs()},
      {.name = "ida",
       .summary = "SUNDIALS IDA: BDF of orders 1 to 5 on the stabilized index-2 form of the constrained top",
       .fits = Fits::with_constraints,
       .formulation = "R3xS3",
       .scenes = false,
       .options = tolerance_alone,
       .title = [](const OptionValues&) -> std::string { return "IDA, stabilized index-2"; },
       .orders = [](const OptionValues&) { return same_order(5); },
       .runs = outside::ida_runs()}};
  return list;
}

const OutsideMethod* find_outside_method(std::string_view name) {
  const auto& list = outside_methods();
  const auto place = std::find_if(list.begin(), list.end(),
                                  [&](const OutsideMethod& method) { return method.name == name; });
  return place == list.end() ? nullptr : &*place;
}

std::string_view outside_obstacle() {
  return sundials_version().empty()
             ? "this liebench was built without SUNDIALS; install libsundials-dev and build again"
             : "";
}

}  // namespace liebench
