#include "integrators/klu_factorization.h"

#include <klu.h>

#include <type_traits>

namespace liebench {

static_assert(std::is_same_v<std::int32_t, int>, "what KLU's indices are");

struct KluFactorization::Factors {
  Factors() { klu_defaults(&common); }
  ~Factors() {
    klu_free_numeric(&numeric, &common);
    klu_free_symbolic(&symbolic, &common);
  }
  Factors(const Factors&) = delete;
  Factors& operator=(const Factors&) = delete;

  klu_common common;
  klu_symbolic* symbolic = nullptr;
  klu_numeric* numeric = nullptr;
};

KluFactorization::KluFactorization() = default;
KluFactorization::~KluFactorization() = default;
KluFactorization::KluFactorization(KluFactorization&&) noexcept = default;
KluFactorization& KluFactorization::operator=(KluFactorization&&) noexcept = default;

bool KluFactorization::empty() const {
  return factors_ == nullptr || factors_->numeric == nullptr;
}

bool KluFactorization::factorize(std::span<std::int32_t> begins, std::span<std::int32_t> rows,
                                 std::span<double> values) {
  if (factors_ == nullptr) factors_ = std::make_unique<Factors>();
  Factors& f = *factors_;
  if (f.symbolic == nullptr) {
    f.symbolic = klu_analyze(int(begins.size()) - 1, begins.data(), rows.data(), &f.common);
    if (f.symbolic == nullptr) return false;
  }
  if (f.numeric != nullptr) {
    const bool done =
        klu_refactor(begins.data(), rows.data(), values.data(), f.symbolic, f.numeric, &f.common) != 0;
    klu_rgrowth(begins.data(), rows.data(), values.data(), f.symbolic, f.numeric, &f.common);
    // The old pivots serve while they do not let the entries grow.
    if (done && f.common.status == KLU_OK && f.common.rgrowth > 1e-6) return true;
    klu_free_numeric(&f.numeric, &f.common);
  }
  f.numeric = klu_factor(begins.data(), rows.data(), values.data(), f.symbolic, &f.common);
  if (f.numeric != nullptr && f.common.status == KLU_OK) return true;
  klu_free_numeric(&f.numeric, &f.common);
  return false;
}

void KluFactorization::solve(double* x) const {
  klu_solve(factors_->symbolic, factors_->numeric, factors_->symbolic->n, 1, x, &factors_->common);
}

double KluFactorization::flops() const {
  klu_flops(factors_->symbolic, factors_->numeric, &factors_->common);
  return factors_->common.flops;
}

std::uint64_t KluFactorization::entries() const {
  return std::uint64_t(factors_->numeric->lnz) + std::uint64_t(factors_->numeric->unz);
}

}  // namespace liebench
