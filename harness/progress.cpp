#include "harness/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace liebench {

Progress::Progress(std::string title, double total)
    : title_(std::move(title)),
      total_(std::max(total, 1e-300)),
      terminal_(isatty(STDERR_FILENO) == 1),
      start_(std::chrono::steady_clock::now()),
      drawn_(start_) {
  draw(true);
}

Progress::~Progress() {
  erase();
}

void Progress::advance(double work) {
  const std::lock_guard lock(mutex_);
  done_ += work;
  draw(false);
}

void Progress::message(const std::string& text) {
  const std::lock_guard lock(mutex_);
  erase();
  fmt::print(stderr, "{}\n", text);
  draw(true);
}

void Progress::draw(bool always) {
  if (!terminal_) return;
  const auto now = std::chrono::steady_clock::now();
  if (!always && now - drawn_ < std::chrono::milliseconds(100)) return;
  drawn_ = now;
  constexpr int width = 32;
  const double fraction = std::clamp(done_ / total_, 0.0, 1.0);
  const int filled = int(fraction * width);
  const double seconds = std::chrono::duration<double>(now - start_).count();
  std::string remaining;
  if (fraction > 0.02)
    remaining = fmt::format("  about {:.0f} s left", seconds * (1.0 - fraction) / fraction);
  fmt::print(stderr, "\r\033[K{:<10} [{:=<{}}{: <{}}] {:3.0f} %{}", title_, "", filled, "", width - filled,
             100.0 * fraction, remaining);
  std::fflush(stderr);
}

void Progress::erase() {
  if (!terminal_) return;
  fmt::print(stderr, "\r\033[K");
  std::fflush(stderr);
}

}  // namespace liebench
