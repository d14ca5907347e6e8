#include "proofmass/serve/view/mapped_values.hpp"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>
#include <utility>

namespace proofmass::serve {

Result<MappedValues> MappedValues::open(const std::string& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  struct stat found{};
  if (file < 0 || ::fstat(file, &found) != 0) {
    const Error error{Errc::unreadable, path + ": " + std::strerror(errno)};
    if (file >= 0) ::close(file);
    return error;
  }
  MappedValues out;
  const auto bytes = static_cast<std::size_t>(found.st_size);
  void* memory = bytes == 0 ? nullptr : ::mmap(nullptr, bytes, PROT_READ, MAP_SHARED, file, 0);
  ::close(file);
  if (memory == MAP_FAILED) return Error{Errc::unreadable, path + ": " + std::strerror(errno)};
  out.data_ = static_cast<const double*>(memory);
  out.size_ = bytes / sizeof(double);
  return out;
}

MappedValues::MappedValues(MappedValues&& other) noexcept
    : data_(std::exchange(other.data_, nullptr)), size_(std::exchange(other.size_, 0)) {}

MappedValues& MappedValues::operator=(MappedValues&& other) noexcept {
  std::swap(data_, other.data_);
  std::swap(size_, other.size_);
  return *this;
}

MappedValues::~MappedValues() {
  if (data_ != nullptr) ::munmap(const_cast<double*>(data_), size_ * sizeof(double));
}

}  // namespace proofmass::serve
