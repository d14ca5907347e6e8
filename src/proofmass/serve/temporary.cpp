#include "proofmass/serve/temporary.hpp"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fmt/format.h>
#include <unistd.h>
#include <utility>

namespace proofmass::serve {
namespace {

Error cannot_make(const std::string& folder) {
  return {Errc::unwritable, fmt::format("{}: cannot be written: {}", folder, std::strerror(errno))};
}

}  // namespace

Result<std::string> temporary_file(const std::string& folder, const std::string& prefix) {
  std::string path = folder + "/" + prefix + "XXXXXX";
  const int descriptor = ::mkstemp(path.data());
  if (descriptor < 0) return cannot_make(folder);
  ::close(descriptor);
  return path;
}

Result<TemporaryFolder> TemporaryFolder::make(const std::string& parent) {
  std::string path = parent + "/proofmass-serve-XXXXXX";
  if (::mkdtemp(path.data()) == nullptr) return cannot_make(parent);
  return TemporaryFolder(std::move(path));
}

TemporaryFolder::TemporaryFolder(TemporaryFolder&& other) noexcept
    : path_(std::exchange(other.path_, {})) {}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  if (!path_.empty()) std::filesystem::remove_all(path_, ignored);
}

}  // namespace proofmass::serve
