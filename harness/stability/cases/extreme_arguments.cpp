#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "groups/extended.h"
#include "groups/s3.h"
#include "groups/s3_r3.h"
#include "groups/se3.h"
#include "groups/so3.h"
#include "groups/unit_dual_quaternions.h"
#include "harness/stability/cases/cases.h"

// exp, log, the tangent operator and its inverse in double at the arguments where closed forms break, against 106 bits.

namespace liebench {

namespace extreme_arguments_case {

namespace {

constexpr double eps = 0x1p-52;
constexpr double pi = std::numbers::pi;

template <class T, class Vector>
Vector argument(double angle) {
  Vector v = Vector::Constant(T(0.0));
  const std::array<double, 3> axis{0.36, 0.48, -0.8};
  for (int i = 0; i < 3; ++i) v(v.size() - 3 + i) = T(axis[std::size_t(i)]) * T(angle);
  if (v.size() == 6) {
    v(0) = T(0.5);
    v(1) = T(-1.25);
    v(2) = T(2.0);
  }
  return v;
}

// The largest difference, as part of the largest entry or of 1.
template <class A, class B>
double difference(const A& in_double, const B& exact) {
  double largest = 0.0, size = 1.0;
  for (Eigen::Index i = 0; i < exact.size(); ++i) {
    const double wide = to_double(exact.data()[i]);
    size = std::max(size, std::abs(wide));
    const double d = std::abs(to_double(Extended(in_double.data()[i]) - exact.data()[i]));
    // A NaN is the largest difference of all.
    if (!(d <= largest)) largest = d;
  }
  return largest / size;
}

template <template <class> class Group>
Finding examine(double angle) {
  using Double = Group<double>;
  using Wide = Group<Extended>;
  const auto v = argument<double, typename Double::Tangent>(angle);
  const auto w = typename Wide::Tangent(v.template cast<Extended>());
  Finding finding;
  finding.what = "error / allowed";
  finding.measured["exp"] = difference(Double::stacked(Double::exp(v)), Wide::stacked(Wide::exp(w)));
  finding.measured["tangent"] = difference(Double::tangent(v), Wide::tangent(w));
  // Singular at 2 pi: condition 2 pi / |2 pi - angle|.
  const double inverse_condition = std::max(1.0, 2.0 * pi / std::abs(2.0 * pi - angle));
  finding.measured["tangent_inverse"] =
      difference(Double::tangent_inverse(v), Wide::tangent_inverse(w)) / inverse_condition;
  // At pi the axis may come out reversed: both are logarithms. Compared through exp, where they are the same; there the position
  // of a rigid motion has the condition of T^{-1}.
  const auto q = Double::exp(v);
  const auto again = Wide::exp(typename Wide::Tangent(Double::log(q).template cast<Extended>()));
  const auto wide_q = Wide::exp(w);
  const auto stacked = Wide::stacked(again), exact = Wide::stacked(wide_q);
  double round_trip = difference(stacked, exact);
  // A unit quaternion and its negative are the same rotation.
  if constexpr (requires { typename Wide::Represented; }) {
    const auto a = Wide::represented(again), b = Wide::represented(wide_q);
    round_trip = difference(Wide::Represented::stacked(a), Wide::Represented::stacked(b));
  }
  finding.measured["log"] = round_trip / inverse_condition;
  // Below pi there is one, however small.
  if (angle > 0.0 && angle < 3.0) {
    const typename Wide::Tangent error = Double::log(q).template cast<Extended>() - w;
    const auto rotation = [](const auto& u) { return u.template tail<3>().cwiseAbs().maxCoeff(); };
    finding.measured["log_of_rotation"] = to_double(Extended(rotation(error) / rotation(w)));
  }
  double largest = 0.0;
  for (const auto& [key, value] : finding.measured)
    if (!(value <= largest)) largest = value;
  if (!std::isfinite(largest)) {
    finding.outcome = Outcome::non_finite;
    finding.measured.clear();
    return finding;
  }
  constexpr double allowed = 64.0 * eps;
  finding.amount = largest / allowed;
  finding.grade = largest <= allowed ? Grade::survived : largest <= 1e-10 ? Grade::degraded : Grade::failed;
  finding.reason = "closed forms and series lose no digits; T^{-1} has the condition 2 pi / |2 pi - angle|";
  return finding;
}

template <template <class> class Group>
void add(std::vector<Trial>& all, const char* subject) {
  for (const double angle : {0.0, 1e-300, 1e-160, 1e-9, 0.5, pi - 1e-10, pi, 2.0 * pi - 1e-8}) {
    Trial t;
    t.subject = subject;
    t.variant = fmt::format("angle {}", angle);
    // Clang 14 forgets, in a template, to destroy what an assignment makes of braces alone.
    t.parameters = Json{{"group", subject}, {"angle", angle}};
    t.work = 0.01;
    t.run = [=] { return examine<Group>(angle); };
    all.push_back(std::move(t));
  }
}

std::vector<Trial> trials() {
  std::vector<Trial> all;
  add<SO3>(all, "group SO(3)");
  add<S3>(all, "group S^3");
  add<SE3>(all, "group SE(3)");
  add<S3R3>(all, "group S^3 |x R^3");
  add<UnitDualQuaternions>(all, "group unit dual quaternions");
  return all;
}

}  // namespace

}  // namespace extreme_arguments_case

StabilityCase extreme_arguments() {
  return {.name = "extreme_arguments",
          .title = "Extreme arguments",
          .question = "Are exp, log, T and T^{-1} right at 0, 1e-300, near pi and near 2 pi?",
          .criterion =
              "survived: within 64 units of round-off of 106 bits, times the condition of T^{-1} and log "
              "near 2 pi",
          .theory = "closed forms with sin(x/2)/x, series below 1/2, atan2 of the quaternion",
          .trials = extreme_arguments_case::trials};
}

}  // namespace liebench
