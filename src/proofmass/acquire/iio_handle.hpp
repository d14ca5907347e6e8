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

/// Empty, with errno set, where there is none. The text is a copy since libiio 0.24 cuts the port
/// off where it stands.
[[nodiscard]] IioContext open_iio_context(std::string uri);

/// The socket of a daemon that died raises SIGPIPE in the thread that writes to it, which would end
/// the program. Blocked for the calling thread, which therefore is one of ours, the call fails.
void block_broken_pipes();

/// What libiio's negative number means: "Device or resource busy".
[[nodiscard]] std::string iio_reason(long code);

/// "lis3dh", or its id where it has no name.
[[nodiscard]] std::string iio_name(const iio_device* device);

/// An attribute as text, without the blanks around it; nullopt if it cannot be read.
[[nodiscard]] std::optional<std::string> iio_text(const iio_device* device, const char* attribute);
[[nodiscard]] std::optional<std::string> iio_text(const iio_channel* channel,
                                                  const char* attribute);

/// All devices that are no trigger, or all triggers.
[[nodiscard]] std::vector<iio_device*> iio_devices(const iio_context* context, bool triggers);

/// "lis3dh (iio:device0), kxcjk1013 (iio:device1)"; "none" if there are none.
[[nodiscard]] std::string list_of(const std::vector<iio_device*>& devices);

}  // namespace proofmass::acquire
