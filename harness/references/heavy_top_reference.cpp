#include "harness/references/heavy_top_reference.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <future>
#include <stdexcept>
#include <type_traits>
#include <vector>

#include "harness/references/heavy_top_closed_form.h"
#include "harness/references/heavy_top_extrapolation.h"
#include "harness/references/heavy_top_wide.h"

namespace liebench {

namespace {

// Of the computation and of the layout of the payload; a change of either needs the next number.
constexpr std::uint32_t payload_version = 1;
constexpr double largest_disagreement = 1e-25;
// Coefficients to 2^-106 and some 20 operations of a few 2^-104 each on numbers that shrink with the degree;
// the largest difference seen is 3e-32.
constexpr double storage_rounding = 1e-31;
constexpr int check_times = 8;

using Piece = HeavyTopTrajectory::Piece;
static_assert(std::is_trivially_copyable_v<Piece> && sizeof(Piece) % sizeof(double) == 0);

HeavyTopWitness as_witness(const HeavyTopTrajectory::Values& v, double t) {
  return {t,
          rotation_matrix({to_wide(v[0]), to_wide(v[1]), to_wide(v[2]), to_wide(v[3])}),
          {to_wide(v[4]), to_wide(v[5]), to_wide(v[6])}};
}

double distance(const WideVector& a, const WideVector& b) {
  return norm(WideVector{a[0] - b[0], a[1] - b[1], a[2] - b[2]});
}

double disagreement(const HeavyTopWitness& a, const HeavyTopWitness& b, double omega_scale) {
  double rotation = 0;
  for (std::size_t i = 0; i < 3; ++i) rotation = std::hypot(rotation, distance(a.R[i], b.R[i]));
  const double result = std::max(rotation / std::sqrt(3.0), distance(a.omega, b.omega) / omega_scale);
  // A NaN must not pass for agreement: std::max and < let it.
  return std::isfinite(result) ? result : HUGE_VAL;
}

std::string scientific(double x) {
  std::array<char, 32> text;
  std::snprintf(text.data(), text.size(), "%.2g", x);
  return text.data();
}

template <std::size_t N>
std::string text_of(const std::array<double, N>& v) {
  std::string text;
  for (const double x : v) text += ' ' + detail::shortest_decimal_text(x);
  return text;
}

ReferenceKey key_of(const HeavyTopParameters& p, double t_end, double margin) {
  std::string input = "mass " + detail::shortest_decimal_text(p.mass) + "\ninertia";
  for (const auto& row : p.inertia) input += text_of(row);
  input += "\ncenter_of_mass" + text_of(p.center_of_mass) + "\ngravity" + text_of(p.gravity);
  input += "\nangular_velocity" + text_of(p.angular_velocity) + "\norientation" + text_of(p.orientation);
  input +=
      "\nt_end " + detail::shortest_decimal_text(t_end) + "\nmargin " + detail::shortest_decimal_text(margin);
  return {"heavy_top", payload_version, input};
}

Eigen::Matrix<Extended, 3, 1> rounded(const WideVector& v) {
  return {to_extended(v[0]), to_extended(v[1]), to_extended(v[2])};
}

Eigen::Matrix<Extended, 3, 3> rounded(const WideMatrix& A) {
  Eigen::Matrix<Extended, 3, 3> B;
  for (int i = 0; i < 3; ++i) B.row(i) = rounded(A[static_cast<std::size_t>(i)]).transpose();
  return B;
}

std::uint64_t next_identity() {
  static std::atomic<std::uint64_t> last{0};
  return ++last;
}

template <class T>
void append(std::string& bytes, const T& value) {
  std::array<char, sizeof(T)> raw;
  std::memcpy(raw.data(), &value, sizeof(T));
  bytes.append(raw.data(), raw.size());
}

template <class T>
T take(std::string_view& bytes) {
  if (bytes.size() < sizeof(T)) throw std::runtime_error("heavy top reference: the payload is too short");
  T value;
  // Into an object of a trivially copyable type; the cast tells GCC so, dd_real having a constructor of its
  // own.
  std::memcpy(static_cast<void*>(&value), bytes.data(), sizeof(T));
  bytes.remove_prefix(sizeof(T));
  return value;
}

}  // namespace

HeavyTopReference::HeavyTopReference(Prepared, const HeavyTopParameters& parameters, double t_end,
                                     double margin)
    : identity_(next_identity()), parameters_(parameters), t_end_(t_end), margin_(margin) {
  if (!(t_end > 0 && std::isfinite(t_end))) {
    throw std::invalid_argument("heavy top reference: t_end must be positive and finite");
  }
  if (!(margin >= 0 && std::isfinite(margin))) {
    throw std::invalid_argument("heavy top reference: the margin must be finite and not negative");
  }
  const HeavyTopWideData data(parameters);
  inertia_ = rounded(data.inertia);
  inertia_inverse_ = rounded(data.inertia_inverse);
  first_moment_ = rounded(data.first_moment);
  gravity_ = rounded(data.gravity);
}

HeavyTopReference::HeavyTopReference(const HeavyTopParameters& parameters, double t_end, double margin)
    : HeavyTopReference(Prepared{}, parameters, t_end, margin) {
  compute();
}

HeavyTopReference HeavyTopReference::load_or_build(const HeavyTopParameters& parameters, double t_end,
                                                   const ReferenceCache& cache,
                                                   const MessageCallback& message, double margin) {
  HeavyTopReference reference(Prepared{}, parameters, t_end, margin);
  bool computed = false;
  const auto build = [&] {
    reference.compute();
    computed = true;
    return reference.to_payload();
  };
  const ReferenceKey key = key_of(parameters, t_end, margin);
  const std::string payload = cache.load_or_build(key, build, message);
  if (computed) return reference;
  try {
    reference.from_payload(payload);
  } catch (const std::runtime_error& error) {
    // A whole file of another layout: of a program that forgot to count payload_version up.
    if (message) message(std::string(error.what()) + "; computing it again");
    cache.store(key, build(), message);
  }
  return reference;
}

void HeavyTopReference::compute() {
  std::vector<double> times;
  for (int i = 1; i <= check_times; ++i) times.push_back(t_end_ * i / check_times);
  if (t_end_ + margin_ > times.back()) times.push_back(t_end_ + margin_);

  auto extrapolation =
      std::async(std::launch::async, [&] { return heavy_top_by_extrapolation(parameters_, times); });
  trajectory_ = heavy_top_by_taylor(parameters_, t_end_ + margin_);
  const std::vector<HeavyTopWitness> witnesses = extrapolation.get();
  const std::optional<HeavyTopClosedForm> closed_form = HeavyTopClosedForm::of(parameters_);

  double omega_scale = HeavyTopWideData(parameters_).pendulum_frequency();
  for (const HeavyTopWitness& w : witnesses) omega_scale = std::max(omega_scale, norm(w.omega));
  if (omega_scale == 0) omega_scale = 1;
  double by_extrapolation = 0;
  double by_closed_form = 0;
  for (const HeavyTopWitness& witness : witnesses) {
    const HeavyTopWitness own = as_witness(trajectory_.at(witness.t), witness.t);
    by_extrapolation = std::max(by_extrapolation, disagreement(own, witness, omega_scale));
    if (closed_form) {
      by_closed_form = std::max(by_closed_form, disagreement(own, closed_form->at(witness.t), omega_scale));
    }
  }
  const double jump = trajectory_.largest_jump(omega_scale);
  const double worst = std::max({by_extrapolation, by_closed_form, jump});
  if (!(worst <= largest_disagreement)) {
    throw std::runtime_error("heavy top reference: the Taylor series differs from extrapolation by " +
                             scientific(by_extrapolation) +
                             (closed_form ? ", from the closed form by " + scientific(by_closed_form) : "") +
                             ", and between its own pieces by " + scientific(jump) + "; allowed is " +
                             scientific(largest_disagreement));
  }
  error_estimate_ = worst + storage_rounding;
  method_ =
      "Taylor series (order 34, 50 digits) on unit quaternion, Omega and R^T gamma; witnesses: "
      "Gragg-Bulirsch-Stoer extrapolation (order 32, 50 digits) on rotation matrix and Omega, " +
      scientific(by_extrapolation) + " away" +
      (closed_form
           ? ", and the closed form in theta functions (50 digits), " + scientific(by_closed_form) + " away"
           : "");
}

HeavyTopState HeavyTopReference::at(const Extended& t) const {
  // 15 MB a thread.
  constexpr unsigned memory_bits = 14;
  struct Remembered {
    std::uint64_t identity = 0;
    HeavyTopState state;
  };
  thread_local std::vector<Remembered> memory(std::size_t{1} << memory_bits);
  constexpr std::uint64_t golden = 0x9e3779b97f4a7c15U;
  Remembered& place = memory[(std::bit_cast<std::uint64_t>(t.x[0]) * golden) >> (64 - memory_bits)];
  if (place.identity != identity_ || place.state.t.x[0] != t.x[0] || place.state.t.x[1] != t.x[1]) {
    place.state = computed_at(t);
    place.identity = identity_;
  }
  return place.state;
}

HeavyTopState HeavyTopReference::computed_at(const Extended& t) const {
  const HeavyTopTrajectory::Values v = trajectory_.at(t);
  HeavyTopState state;
  state.t = t;
  state.orientation << v[0], v[1], v[2], v[3];
  state.omega << v[4], v[5], v[6];
  const auto& [w, x, y, z, o1, o2, o3] = v;
  const Extended xx = x * x, yy = y * y, zz = z * z, xy = x * y, xz = x * z, yz = y * z;
  const Extended wx = w * x, wy = w * y, wz = w * z;
  state.R << 1.0 - mul_pwr2(yy + zz, 2.0), mul_pwr2(xy - wz, 2.0), mul_pwr2(xz + wy, 2.0),  //
      mul_pwr2(xy + wz, 2.0), 1.0 - mul_pwr2(xx + zz, 2.0), mul_pwr2(yz - wx, 2.0),         //
      mul_pwr2(xz - wy, 2.0), mul_pwr2(yz + wx, 2.0), 1.0 - mul_pwr2(xx + yy, 2.0);

  const Eigen::Matrix<Extended, 3, 1> momentum = inertia_ * state.omega;
  const Eigen::Matrix<Extended, 3, 1> gamma = state.R.transpose() * gravity_;
  const Eigen::Matrix<Extended, 3, 1> moment = momentum.cross(state.omega) + first_moment_.cross(gamma);
  state.omega_dot = inertia_inverse_ * moment;
  return state;
}

std::string HeavyTopReference::to_payload() const {
  std::string bytes;
  append(bytes, error_estimate_);
  append(bytes, trajectory_.end());
  append(bytes, std::uint64_t{method_.size()});
  append(bytes, std::uint64_t{trajectory_.pieces().size()});
  bytes += method_;
  for (const Piece& piece : trajectory_.pieces()) append(bytes, piece);
  return bytes;
}

void HeavyTopReference::from_payload(const std::string& payload) {
  std::string_view bytes = payload;
  error_estimate_ = take<double>(bytes);
  const double end = take<double>(bytes);
  const std::uint64_t method_size = take<std::uint64_t>(bytes);
  const std::uint64_t count = take<std::uint64_t>(bytes);
  if (method_size > bytes.size() || (bytes.size() - method_size) / sizeof(Piece) != count || count == 0) {
    throw std::runtime_error("heavy top reference: the payload has a wrong length");
  }
  method_ = bytes.substr(0, method_size);
  bytes.remove_prefix(method_size);
  std::vector<Piece> pieces;
  pieces.reserve(count);
  for (std::uint64_t i = 0; i < count; ++i) pieces.push_back(take<Piece>(bytes));
  trajectory_ = HeavyTopTrajectory(std::move(pieces), end);
}

}  // namespace liebench
