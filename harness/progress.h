#pragma once

#include <chrono>
#include <mutex>
#include <string>

namespace liebench {

// A progress bar on standard error: drawn where that is a terminal, silent in a pipe. Safe to call from
// several threads.
class Progress {
 public:
  // `total` in any unit of work.
  Progress(std::string title, double total);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void advance(double work);
  // A line of text above the bar, written in a pipe too.
  void message(const std::string& text);

 private:
  void draw(bool always);
  void erase();

  std::mutex mutex_;
  std::string title_;
  double total_;
  double done_ = 0.0;
  bool terminal_;
  std::chrono::steady_clock::time_point start_;
  std::chrono::steady_clock::time_point drawn_;
};

}  // namespace liebench
