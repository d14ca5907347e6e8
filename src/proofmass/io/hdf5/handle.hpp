#pragma once

#include <hdf5.h>
#include <string>
#include <string_view>
#include <utility>

#include "proofmass/core/result.hpp"
#include "proofmass/io/hdf5/library.hpp"

namespace proofmass::io::hdf5 {

/// An identifier of the HDF5 library, closed by its owner.
class Handle {
 public:
  using Close = herr_t (*)(hid_t);

  Handle(hid_t id, Close closing) : id_(id), close_(closing) {}
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  Handle& operator=(Handle&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(close_, other.close_);
    return *this;
  }
  ~Handle() { close(); }

  /// False if pending data could not be written.
  bool close() { return id_ < 0 || close_(std::exchange(id_, -1)) >= 0; }

  explicit operator bool() const { return id_ >= 0; }
  operator hid_t() const { return id_; }  // NOLINT(google-explicit-constructor)

 private:
  hid_t id_;
  Close close_;
};

/// Opens a file for reading; afterwards this process can open no other, so that nothing in the file
/// can refer to one. Errors: corrupt, with the library's reason.
[[nodiscard]] Result<Handle> open_source(const Source& source);

/// The library's message for the last failure.
[[nodiscard]] std::string failure_reason();

/// The name of the real part, if a type is a complex number: "real", "r".
[[nodiscard]] std::string real_part(hid_t type);

}  // namespace proofmass::io::hdf5
