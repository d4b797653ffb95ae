#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace liebench {

// Where the cache tells its user what it noticed; may be empty.
using MessageCallback = std::function<void(std::string_view)>;

// What a payload is the result of: two keys that differ in anything are different results.
struct ReferenceKey {
  std::string kind;           // of reference, e.g. "heavy_top"; a part of the file name
  std::uint32_t version = 1;  // of the program that computes it and of the payload's layout
  std::string input;          // canonical text of everything that it depends on
};

// Results that take long, kept in files.
//
// A file is named by the XXH3 hash of its key and holds the whole key, the length of the payload and its XXH3
// checksum. What does not match is reported and computed again; a file is written beside its place, flushed
// to the disk and renamed, so that neither a crash nor a second process leaves half a file under its name. No
// failure of the disk is an error here: the worst is that the result is computed again. Files are in the byte
// order of the machine, and noticed when in another.
class ReferenceCache {
 public:
  // An empty directory turns the cache off. Nothing is created before something is stored.
  explicit ReferenceCache(std::filesystem::path directory = default_directory());

  // $LIEBENCH_CACHE, else $XDG_CACHE_HOME/liebench (if absolute), else $HOME/.cache/liebench, else empty.
  static std::filesystem::path default_directory();

  const std::filesystem::path& directory() const { return directory_; }
  std::filesystem::path file_of(const ReferenceKey& key) const;

  // The stored payload, or nothing: silently if there is no file, with a message if it cannot be used.
  std::optional<std::string> load(const ReferenceKey& key, const MessageCallback& message = {}) const;

  // Whether the payload is stored; a message if not.
  bool store(const ReferenceKey& key, std::string_view payload, const MessageCallback& message = {}) const;

  // load, or else build and store. What `build` throws passes through.
  std::string load_or_build(const ReferenceKey& key, const std::function<std::string()>& build,
                            const MessageCallback& message = {}) const;

 private:
  std::filesystem::path directory_;
};

}  // namespace liebench
