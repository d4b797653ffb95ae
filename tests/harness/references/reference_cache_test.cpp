#include "harness/references/reference_cache.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <thread>
#include <vector>

namespace liebench {
namespace {

namespace fs = std::filesystem;

class ReferenceCacheTest : public testing::Test {
 protected:
  ReferenceCacheTest() {
    std::string pattern = testing::TempDir() + "liebench_cache_XXXXXX";
    directory_ = ::mkdtemp(pattern.data());
    cache_ = ReferenceCache(directory_ / "deep" / "down");
  }
  ~ReferenceCacheTest() override { fs::remove_all(directory_); }

  static std::string read(const fs::path& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  }
  static void write(const fs::path& path, const std::string& bytes) {
    std::ofstream(path, std::ios::binary | std::ios::trunc) << bytes;
  }

  std::string load_or_build() {
    return cache_.load_or_build(
        key_,
        [this] {
          ++builds_;
          return payload_;
        },
        message_);
  }

  fs::path directory_;
  ReferenceCache cache_{fs::path()};
  const ReferenceKey key_{"test", 3, "mass 15\nt_end 2"};
  const std::string payload_{"\0payload \xff\n with all kinds of bytes", 34};
  int builds_ = 0;
  std::vector<std::string> messages_;
  MessageCallback message_ = [this](std::string_view text) { messages_.emplace_back(text); };
};

TEST_F(ReferenceCacheTest, BuildsOnceAndThenReads) {
  EXPECT_EQ(load_or_build(), payload_);
  EXPECT_EQ(load_or_build(), payload_);
  EXPECT_EQ(builds_, 1);
  EXPECT_TRUE(messages_.empty());
}

TEST_F(ReferenceCacheTest, StoresAnEmptyPayload) {
  EXPECT_TRUE(cache_.store(key_, "", message_));
  EXPECT_EQ(cache_.load(key_, message_), "");
}

TEST_F(ReferenceCacheTest, LeavesNothingButTheFileItself) {
  load_or_build();
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(cache_.directory())) files.push_back(entry.path());
  EXPECT_EQ(files, std::vector{cache_.file_of(key_)});
}

TEST_F(ReferenceCacheTest, TellsKindVersionAndInputApart) {
  load_or_build();
  for (const ReferenceKey& other : {ReferenceKey{"tests", 3, key_.input}, ReferenceKey{"test", 4, key_.input},
                                    ReferenceKey{"test", 3, "mass 16"}}) {
    EXPECT_NE(cache_.file_of(other), cache_.file_of(key_));
    EXPECT_FALSE(cache_.load(other, message_));
  }
  EXPECT_TRUE(messages_.empty()) << "a file that is not there is no fault";
}

TEST_F(ReferenceCacheTest, NoticesEveryFlippedBitAndRebuilds) {
  load_or_build();
  const fs::path file = cache_.file_of(key_);
  const std::string good = read(file);
  for (std::size_t i = 0; i < good.size(); ++i) {
    std::string bad = good;
    bad[i] = static_cast<char>(bad[i] ^ (1 << (i % 8)));
    write(file, bad);
    messages_.clear();
    EXPECT_FALSE(cache_.load(key_, message_)) << "byte " << i;
    ASSERT_EQ(messages_.size(), 1u);
    EXPECT_NE(messages_[0].find(file.string()), std::string::npos);
  }
  EXPECT_EQ(load_or_build(), payload_);
  EXPECT_EQ(builds_, 2);
  EXPECT_EQ(read(file), good);
}

TEST_F(ReferenceCacheTest, NoticesEveryTruncationAndAnAppendix) {
  load_or_build();
  const fs::path file = cache_.file_of(key_);
  const std::string good = read(file);
  for (std::size_t length = 0; length < good.size(); ++length) {
    write(file, good.substr(0, length));
    messages_.clear();
    EXPECT_FALSE(cache_.load(key_, message_)) << "length " << length;
    EXPECT_EQ(messages_.size(), 1u);
  }
  write(file, good + "x");
  EXPECT_FALSE(cache_.load(key_, message_));
  EXPECT_EQ(load_or_build(), payload_);
  EXPECT_EQ(builds_, 2);
}

TEST_F(ReferenceCacheTest, DoesNotTakeAForeignFile) {
  const ReferenceKey other{"test", 3, "mass 16\nt_end 2"};
  ASSERT_TRUE(cache_.store(other, "of the other", message_));
  // As a collision of the hashes would have it.
  fs::copy_file(cache_.file_of(other), cache_.file_of(key_));
  EXPECT_EQ(load_or_build(), payload_);
  ASSERT_EQ(messages_.size(), 1u);
  EXPECT_NE(messages_[0].find("another input"), std::string::npos);

  write(cache_.file_of(key_), std::string(4096, 'x'));
  EXPECT_EQ(load_or_build(), payload_);
  ASSERT_EQ(messages_.size(), 2u);
  EXPECT_NE(messages_[1].find("not a file of this cache"), std::string::npos);
  EXPECT_EQ(builds_, 2);
}

TEST_F(ReferenceCacheTest, GoesOnWhenItsPlaceIsADirectory) {
  fs::create_directories(cache_.file_of(key_));
  EXPECT_EQ(load_or_build(), payload_);
  EXPECT_EQ(messages_.size(), 2u) << "neither read nor written";
}

TEST_F(ReferenceCacheTest, GoesOnWithoutADirectoryThatCanBeWritten) {
  write(directory_ / "file", "in the way");
  cache_ = ReferenceCache(directory_ / "file" / "cache");  // not even root can create this
  EXPECT_EQ(load_or_build(), payload_);
  EXPECT_EQ(load_or_build(), payload_);
  EXPECT_EQ(builds_, 2);
  ASSERT_EQ(messages_.size(), 2u);
  EXPECT_NE(messages_[0].find("cannot write"), std::string::npos);
}

TEST_F(ReferenceCacheTest, IsOffWithoutADirectory) {
  cache_ = ReferenceCache(fs::path());
  EXPECT_EQ(load_or_build(), payload_);
  EXPECT_EQ(messages_.size(), 1u);
}

TEST_F(ReferenceCacheTest, PassesOnWhatBuildThrowsAndStoresNothing) {
  const auto fail = []() -> std::string { throw std::runtime_error("no"); };
  EXPECT_THROW(cache_.load_or_build(key_, fail, message_), std::runtime_error);
  EXPECT_FALSE(fs::exists(cache_.file_of(key_)));
}

TEST_F(ReferenceCacheTest, WorksWithoutAMessageCallback) {
  cache_ = ReferenceCache(fs::path());
  EXPECT_EQ(cache_.load_or_build(key_, [this] { return payload_; }), payload_);
}

TEST_F(ReferenceCacheTest, NeverShowsHalfAFileToAConcurrentReader) {
  const std::string large(300'000, 'p');
  std::atomic<int> faults = 0;
  std::atomic<int> wrong = 0;
  const auto work = [&] {
    for (int i = 0; i < 15; ++i) {
      const MessageCallback count = [&](std::string_view) { ++faults; };
      cache_.store(key_, large, count);
      if (cache_.load(key_, count) != large) ++wrong;
    }
  };
  std::vector<std::thread> threads;
  for (int i = 0; i < 4; ++i) threads.emplace_back(work);
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(faults, 0);
  EXPECT_EQ(wrong, 0);
}

TEST_F(ReferenceCacheTest, FindsItsDirectoryInTheEnvironment) {
  const auto keep = [](const char* name) {
    const char* value = std::getenv(name);
    return std::pair<std::string, std::optional<std::string>>(
        name, value ? std::optional<std::string>(value) : std::nullopt);
  };
  const std::vector before{keep("LIEBENCH_CACHE"), keep("XDG_CACHE_HOME"), keep("HOME")};
  ::setenv("LIEBENCH_CACHE", "/a", 1);
  ::setenv("XDG_CACHE_HOME", "/b", 1);
  ::setenv("HOME", "/c", 1);
  EXPECT_EQ(ReferenceCache::default_directory(), "/a");
  ::unsetenv("LIEBENCH_CACHE");
  EXPECT_EQ(ReferenceCache::default_directory(), "/b/liebench");
  ::setenv("XDG_CACHE_HOME", "relative", 1);
  EXPECT_EQ(ReferenceCache::default_directory(), "/c/.cache/liebench");
  ::unsetenv("XDG_CACHE_HOME");
  ::unsetenv("HOME");
  EXPECT_EQ(ReferenceCache::default_directory(), "");
  for (const auto& [name, value] : before) {
    if (value) ::setenv(name.c_str(), value->c_str(), 1);
  }
}

}  // namespace
}  // namespace liebench
