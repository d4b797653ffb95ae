#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "harness/errors.h"
#include "harness/strict_json.h"

namespace liebench {

// What a reader makes of any bytes: it accepts them or says what is wrong by an InputError. Everything else is a finding.
template <class Reader>
int read_any(const std::uint8_t* data, std::size_t size, const Reader& read) {
  try {
    read(parse_json(std::string_view(reinterpret_cast<const char*>(data), size), "input"));
  } catch (const InputError&) {
  }
  return 0;
}

}  // namespace liebench
