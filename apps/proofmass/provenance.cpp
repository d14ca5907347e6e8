#include "provenance.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <openssl/evp.h>
#include <stop_token>
#include <sys/utsname.h>
#include <thread>

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

// The file, or those of a folder in the order of their names.
void add_sums(const std::string& path,
              const std::stop_token& stop,
              std::vector<ProvenanceInput>& all) {
  constexpr std::size_t most_files = 1000;
  std::error_code problem;
  if (path == "-") {
    all.push_back(without_sum(path, "standard input is read once"));
  } else if (fs::is_directory(path, problem)) {
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
  sums_->thread =
      std::jthread([sums = sums_.get(), files = std::move(files)](std::stop_token stop) {
        for (const std::string& file : files) add_sums(file, stop, sums->found);
      });
}

Invocation::~Invocation() = default;

const report::Provenance& Invocation::provenance() {
  if (sums_->thread.joinable()) {
    sums_->thread.join();
    provenance_.inputs = std::move(sums_->found);
  }
  return provenance_;
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
