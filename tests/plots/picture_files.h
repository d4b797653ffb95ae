#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>

#include "plots/layout.h"

namespace liebench {

/// A folder of its own for each test, gone after it.
class PictureFiles : public testing::Test {
 protected:
  void SetUp() override {
    const testing::TestInfo* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::temp_directory_path() / (std::string("liebench_") + test->test_suite_name() +
                                                        "_" + test->name() + "_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  static std::string read(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  std::filesystem::path folder_;
};

inline std::size_t occurrences(std::string_view text, std::string_view part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string_view::npos; at = text.find(part, at + part.size()))
    ++count;
  return count;
}

/// They share an area of more than rounding.
inline bool overlap(const Rectangle& a, const Rectangle& b) {
  constexpr double rounding = 1e-9;
  return a.left + a.width > b.left + rounding && b.left + b.width > a.left + rounding &&
         a.lower + a.height > b.lower + rounding && b.lower + b.height > a.lower + rounding;
}

/// Within a picture of `width` by `height`.
inline bool lies_inside(const Rectangle& place, double width, double height) {
  return place.left >= 0 && place.lower >= 0 && place.left + place.width <= width &&
         place.lower + place.height <= height;
}

}  // namespace liebench
