#pragma once

#include <stdexcept>
#include <string>

namespace liebench {

// Input that cannot be run: exit status 2. The place is a JSON pointer ("/step_sizes/2") or an option
// ("--jobs").
class InputError : public std::runtime_error {
 public:
  InputError(const std::string& place, const std::string& message)
      : std::runtime_error(place.empty() ? message : place + ": " + message),
        place_(place),
        message_(message) {}
  const std::string& place() const { return place_; }
  // Without the place.
  const std::string& message() const { return message_; }

 private:
  std::string place_;
  std::string message_;
};

// The machine failed, not the input and not a method: disk full, folder not writable, gnuplot missing. Exit
// status 3.
class MachineError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace liebench
