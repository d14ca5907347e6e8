#pragma once

#include <iio.h>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace proofmass::acquire {

struct CloseIioContext {
  void operator()(iio_context* context) const { iio_context_destroy(context); }
};
using IioContext = std::unique_ptr<iio_context, CloseIioContext>;

/// Null on failure, with errno set. The text is a copy because libiio 0.24 truncates the port in
/// place.
[[nodiscard]] IioContext open_iio_context(const std::string& uri);

/// The socket of a daemon that died raises SIGPIPE in the thread that writes to it, which would end
/// the program. If the signal is blocked in the calling thread (which must be ours), the call fails
/// instead.
void block_broken_pipes();

/// Text of libiio's negative error code: "Device or resource busy".
[[nodiscard]] std::string iio_reason(long code);

/// "lis3dh", or its id if it has no name.
[[nodiscard]] std::string iio_name(const iio_device* device);

/// An attribute as text, without surrounding blanks; nullopt if it cannot be read.
[[nodiscard]] std::optional<std::string> iio_text(const iio_device* device, const char* attribute);
[[nodiscard]] std::optional<std::string> iio_text(const iio_channel* channel,
                                                  const char* attribute);

/// All devices that are not triggers, or all triggers.
[[nodiscard]] std::vector<iio_device*> iio_devices(const iio_context* context, bool triggers);

/// "lis3dh (iio:device0), kxcjk1013 (iio:device1)"; "none" if there are none.
[[nodiscard]] std::string list_of(const std::vector<iio_device*>& devices);

}  // namespace proofmass::acquire
