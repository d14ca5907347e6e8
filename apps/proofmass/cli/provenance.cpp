#include "cli/provenance.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fcntl.h>
#include <filesystem>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <openssl/evp.h>
#include <optional>
#include <poll.h>
#include <stop_token>
#include <sys/socket.h>
#include <sys/utsname.h>
#include <thread>
#include <tuple>
#include <unistd.h>
#include <utility>

#include "source_commit.hpp"

namespace proofmass::app {
namespace {

namespace fs = std::filesystem;
using report::ProvenanceInput;

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
struct FreeDigest {
  void operator()(EVP_MD_CTX* context) const { EVP_MD_CTX_free(context); }
};

std::string hexadecimal(const unsigned char* bytes, unsigned int count) {
  std::string text;
  for (unsigned int k = 0; k < count; ++k) text += fmt::format("{:02x}", bytes[k]);
  return text;
}

ProvenanceInput without_sum(const std::string& path, const char* reason) {
  return {.path = path, .reason = reason};
}

ProvenanceInput summed(const std::string& path, const std::stop_token& stop) {
  const std::unique_ptr<std::FILE, CloseFile> file(std::fopen(path.c_str(), "rb"));
  const std::unique_ptr<EVP_MD_CTX, FreeDigest> digest(EVP_MD_CTX_new());
  if (!file || !digest || EVP_DigestInit_ex(digest.get(), EVP_sha256(), nullptr) != 1)
    return without_sum(path, "it cannot be read");
  std::vector<unsigned char> buffer(std::size_t{1} << 20);
  std::uint64_t bytes = 0;
  while (!stop.stop_requested()) {
    const std::size_t count = std::fread(buffer.data(), 1, buffer.size(), file.get());
    if (count == 0) break;
    EVP_DigestUpdate(digest.get(), buffer.data(), count);
    bytes += count;
  }
  if (std::ferror(file.get()) != 0) return without_sum(path, "it cannot be read to its end");
  std::array<unsigned char, EVP_MAX_MD_SIZE> sum{};
  unsigned int length = 0;
  EVP_DigestFinal_ex(digest.get(), sum.data(), &length);
  return {.path = path, .bytes = bytes, .sha256 = hexadecimal(sum.data(), length)};
}

// Checksum of standard input: a proxy between it and its reader.
class SummedStandardInput {
 public:
  /// Replaces standard input by a socket that pass_on() feeds.
  SummedStandardInput() {
    std::array<int, 2> ends{};
    if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) return;
    from_ = ::fcntl(STDIN_FILENO, F_DUPFD_CLOEXEC, 3);
    if (from_ < 0 || ::dup2(ends[1], STDIN_FILENO) < 0) {
      ::close(std::exchange(from_, -1));
      ::close(ends[0]);
    } else {
      to_ = ends[0];
    }
    ::close(ends[1]);
  }
  ~SummedStandardInput() {
    if (from_ >= 0) ::close(from_);
    if (to_ >= 0) ::close(to_);
  }
  SummedStandardInput(const SummedStandardInput&) = delete;
  SummedStandardInput& operator=(const SummedStandardInput&) = delete;

  /// Copies until the end of the input, or until it is no longer read.
  ProvenanceInput pass_on(const std::stop_token& stop) {
    const std::unique_ptr<EVP_MD_CTX, FreeDigest> digest(EVP_MD_CTX_new());
    if (to_ < 0 || !digest || EVP_DigestInit_ex(digest.get(), EVP_sha256(), nullptr) != 1)
      return without_sum("-", "standard input is read once");
    std::vector<char> buffer(std::size_t{1} << 16);
    std::uint64_t bytes = 0;
    for (;;) {
      const ssize_t count = read_some(buffer, stop);
      if (count < 0) return without_sum("-", "standard input was not read to its end");
      if (count == 0) break;
      EVP_DigestUpdate(digest.get(), buffer.data(), static_cast<std::size_t>(count));
      bytes += static_cast<std::uint64_t>(count);
      if (!send_all({buffer.data(), static_cast<std::size_t>(count)}, stop))
        return without_sum("-", "standard input was not read to its end");
    }
    ::close(std::exchange(to_, -1));
    std::array<unsigned char, EVP_MAX_MD_SIZE> sum{};
    unsigned int length = 0;
    EVP_DigestFinal_ex(digest.get(), sum.data(), &length);
    return {.path = "-", .bytes = bytes, .sha256 = hexadecimal(sum.data(), length)};
  }

 private:
  static constexpr int patience_ms = 50;

  static bool is_ready(int descriptor, short event, const std::stop_token& stop) {
    pollfd wanted{descriptor, event, 0};
    while (!stop.stop_requested())
      if (::poll(&wanted, 1, patience_ms) > 0) return true;
    return false;
  }
  ssize_t read_some(std::vector<char>& buffer, const std::stop_token& stop) const {
    if (!is_ready(from_, POLLIN, stop)) return -1;
    return ::read(from_, buffer.data(), buffer.size());
  }
  bool send_all(std::string_view bytes, const std::stop_token& stop) const {
    while (!bytes.empty()) {
      if (!is_ready(to_, POLLOUT, stop)) return false;
      const ssize_t sent = ::send(to_, bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
      if (sent < 0 && errno != EAGAIN && errno != EINTR) return false;
      bytes.remove_prefix(static_cast<std::size_t>(std::max<ssize_t>(sent, 0)));
    }
    return true;
  }

  int from_ = -1, to_ = -1;
};

// The file, or the files of a folder sorted by name.
void add_sums(const std::string& path,
              const std::stop_token& stop,
              std::vector<ProvenanceInput>& all) {
  constexpr std::size_t most_files = 1000;
  std::error_code problem;
  if (fs::is_directory(path, problem)) {
    std::vector<std::string> files;
    for (fs::recursive_directory_iterator at(path, problem), end;
         !problem && at != end && files.size() < most_files; at.increment(problem))
      if (at->is_regular_file(problem)) files.push_back(at->path().string());
    std::ranges::sort(files);
    for (const std::string& file : files) all.push_back(summed(file, stop));
  } else if (fs::is_regular_file(path, problem)) {
    all.push_back(summed(path, stop));
  } else if (fs::exists(path, problem)) {
    all.push_back(without_sum(path, "it is not a regular file"));
  }
}

std::string host_name() {
  utsname host{};
  return ::uname(&host) == 0 ? host.nodename : "";
}

// Source of the variable: https://reproducible-builds.org/specs/source-date-epoch.
std::string date_now() {
  const char* epoch = std::getenv("SOURCE_DATE_EPOCH");
  const std::time_t now = epoch == nullptr ? std::time(nullptr) : std::atoll(epoch);
  return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(now));
}

bool is_plain(const std::string& word) {
  return !word.empty() && std::ranges::all_of(word, [](unsigned char c) {
    return std::isalnum(c) != 0 ||
           std::string_view("-_./=:,+@%").find(static_cast<char>(c)) != std::string_view::npos;
  });
}

}  // namespace

struct Invocation::Sums {
  std::optional<SummedStandardInput> standard_input;
  std::vector<ProvenanceInput> found;
  std::jthread thread;
};

Invocation::Invocation(std::string command,
                       std::vector<std::pair<std::string, std::string>> options,
                       std::vector<std::string> files)
    : provenance_{.command = std::move(command),
                  .options = std::move(options),
                  .date = date_now(),
                  .commit = source_commit,
                  .host = host_name(),
                  .inputs = {}},
      sums_(std::make_unique<Sums>()) {
  if (std::ranges::count(files, "-") == 1) sums_->standard_input.emplace();
  sums_->thread =
      std::jthread([sums = sums_.get(), files = std::move(files)](const std::stop_token& stop) {
        // First, since it must be copied while it is read.
        const auto piped = sums->standard_input ? std::optional(sums->standard_input->pass_on(stop))
                                                : std::nullopt;
        for (const std::string& file : files) {
          if (file != "-")
            add_sums(file, stop, sums->found);
          else
            sums->found.push_back(piped.value_or(without_sum("-", "standard input is read once")));
        }
      });
}

Invocation::~Invocation() = default;

const report::Provenance& Invocation::provenance() {
  if (sums_->thread.joinable()) {
    // Any rest will not be read any more.
    if (sums_->standard_input) ::shutdown(STDIN_FILENO, SHUT_RD);
    sums_->thread.join();
    provenance_.inputs = std::move(sums_->found);
  }
  return provenance_;
}

void Invocation::set_inputs(std::vector<report::ProvenanceInput> inputs) {
  std::ignore = provenance();
  provenance_.inputs = std::move(inputs);
}

std::string program_commit() {
  return source_commit;
}

std::string sha256_of(const std::string& path) {
  std::error_code problem;
  return fs::is_regular_file(path, problem) ? summed(path, {}).sha256 : std::string();
}

std::string quoted(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) {
    if (!text.empty()) text += ' ';
    if (is_plain(word)) {
      text += word;
      continue;
    }
    text += '\'';
    for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
    text += '\'';
  }
  return text;
}

}  // namespace proofmass::app
