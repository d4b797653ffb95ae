#include "harness/references/reference_cache.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <xxhash.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <system_error>
#include <utility>

namespace liebench {

namespace {

constexpr std::array<char, 16> magic = {'l', 'i', 'e', 'b', 'e', 'n', 'c', 'h',
                                        ' ', 'c', 'a', 'c', 'h', 'e', ' ', '1'};

struct Header {
  std::array<char, 16> magic_text;
  std::uint64_t byte_order;  // 1 in the order of the machine that wrote it
  std::uint64_t key_length;
  std::uint64_t payload_length;
  std::uint64_t payload_checksum;
};

std::uint64_t hash(std::string_view bytes) {
  return XXH3_64bits(bytes.data(), bytes.size());
}

std::string canonical(const ReferenceKey& key) {
  return key.kind + '\n' + std::to_string(key.version) + '\n' + key.input;
}

void say(const MessageCallback& message, const std::string& text) {
  if (message) message("reference cache: " + text);
}

std::string reason(int error) {
  return std::generic_category().message(error);
}

// What is wrong with the bytes of a file, or nullptr.
const char* defect(const std::string& bytes, const std::string& key) {
  Header header;
  if (bytes.size() < sizeof header) return "it is truncated";
  std::memcpy(&header, bytes.data(), sizeof header);
  if (header.magic_text != magic) return "it is not a file of this cache";
  if (header.byte_order != 1) return "its header is damaged or of another byte order";
  const std::uint64_t rest = bytes.size() - sizeof header;
  if (header.key_length > rest || header.payload_length > rest - header.key_length) return "it is truncated";
  if (header.payload_length != rest - header.key_length) return "its length is wrong";
  const std::string_view stored_key(bytes.data() + sizeof header, header.key_length);
  if (stored_key != key) return "it belongs to another input or its key is damaged";
  if (hash(std::string_view(bytes).substr(sizeof header + header.key_length)) != header.payload_checksum) {
    return "its checksum is wrong: it is damaged";
  }
  return nullptr;
}

// A file that is removed unless it was renamed.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::filesystem::path& target) : path_(target.string() + ".XXXXXX") {
    descriptor_ = ::mkstemp(path_.data());
    // mkstemp allows the owner alone; the directory decides who may see a reference.
    if (descriptor_ >= 0) ::fchmod(descriptor_, S_IRUSR | S_IWUSR | S_IRGRP | S_IROTH);
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() {
    if (descriptor_ < 0) return;
    ::close(descriptor_);
    if (!renamed_) ::unlink(path_.c_str());
  }

  bool is_open() const { return descriptor_ >= 0; }

  bool write(std::string_view bytes) const {
    while (!bytes.empty()) {
      const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) return false;
      bytes.remove_prefix(static_cast<std::size_t>(written));
    }
    return true;
  }

  bool rename_to(const std::filesystem::path& target) {
    renamed_ = ::fsync(descriptor_) == 0 && std::rename(path_.c_str(), target.c_str()) == 0;
    return renamed_;
  }

 private:
  std::string path_;
  int descriptor_ = -1;
  bool renamed_ = false;
};

std::string environment(const char* name) {
  const char* value = std::getenv(name);
  return value ? value : "";
}

}  // namespace

ReferenceCache::ReferenceCache(std::filesystem::path directory) : directory_(std::move(directory)) {}

std::filesystem::path ReferenceCache::default_directory() {
  if (const std::string own = environment("LIEBENCH_CACHE"); !own.empty()) return own;
  // The XDG specification has a relative path ignored.
  if (const std::filesystem::path xdg = environment("XDG_CACHE_HOME"); xdg.is_absolute())
    return xdg / "liebench";
  if (const std::filesystem::path home = environment("HOME"); !home.empty())
    return home / ".cache" / "liebench";
  return {};
}

std::filesystem::path ReferenceCache::file_of(const ReferenceKey& key) const {
  std::uint64_t value = hash(canonical(key));
  std::string digits(16, '0');
  for (std::size_t i = digits.size(); i-- > 0; value /= 16) digits[i] = "0123456789abcdef"[value % 16];
  return directory_ / (key.kind + "-" + digits + ".ref");
}

std::optional<std::string> ReferenceCache::load(const ReferenceKey& key,
                                                const MessageCallback& message) const {
  if (directory_.empty()) return std::nullopt;
  const std::filesystem::path file = file_of(key);
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status)) return std::nullopt;
  std::ifstream stream(file, std::ios::binary);
  if (!std::filesystem::is_regular_file(status) || !stream) {
    say(message, file.string() + " cannot be read; computing it again");
    return std::nullopt;
  }
  std::string bytes{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  const std::string text = canonical(key);
  if (const char* what = defect(bytes, text)) {
    say(message, file.string() + " cannot be used: " + what + "; computing it again");
    return std::nullopt;
  }
  bytes.erase(0, sizeof(Header) + text.size());
  return bytes;
}

bool ReferenceCache::store(const ReferenceKey& key, std::string_view payload,
                           const MessageCallback& message) const {
  if (directory_.empty()) {
    say(message, "no directory (none of LIEBENCH_CACHE, XDG_CACHE_HOME, HOME is set); going on without");
    return false;
  }
  std::error_code error;
  std::filesystem::create_directories(directory_, error);
  const std::string text = canonical(key);
  const Header header{magic, 1, text.size(), payload.size(), hash(payload)};
  std::array<char, sizeof header> head;
  std::memcpy(head.data(), &header, sizeof header);

  const std::filesystem::path file = file_of(key);
  TemporaryFile temporary(file);
  if (!temporary.is_open() || !temporary.write({head.data(), head.size()}) || !temporary.write(text) ||
      !temporary.write(payload) || !temporary.rename_to(file)) {
    say(message, "cannot write " + file.string() + ": " + reason(errno) + "; going on without");
    return false;
  }
  return true;
}

std::string ReferenceCache::load_or_build(const ReferenceKey& key, const std::function<std::string()>& build,
                                          const MessageCallback& message) const {
  if (std::optional<std::string> payload = load(key, message)) return *std::move(payload);
  std::string payload = build();
  store(key, payload, message);
  return payload;
}

}  // namespace liebench
