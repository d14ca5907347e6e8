#include "proofmass/acquire/iio/handle.hpp"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <string_view>

namespace proofmass::acquire {
namespace {

// `size`: the return value of libiio, which includes a terminating zero, or is an error.
std::optional<std::string> trimmed(const std::array<char, 4096>& text, ssize_t size) {
  if (size < 0 || static_cast<std::size_t>(size) > text.size()) return std::nullopt;
  std::string_view whole(text.data(), static_cast<std::size_t>(size));
  whole = whole.substr(0, whole.find('\0'));
  const std::size_t first = whole.find_first_not_of(" \t\r\n");
  if (first == std::string_view::npos) return std::string();
  return std::string(whole.substr(first, whole.find_last_not_of(" \t\r\n") - first + 1));
}

}  // namespace

void block_broken_pipes() {
  sigset_t pipes;
  sigemptyset(&pipes);
  sigaddset(&pipes, SIGPIPE);
  pthread_sigmask(SIG_BLOCK, &pipes, nullptr);
}

std::string iio_reason(long code) {
  std::array<char, 256> text{};
  iio_strerror(static_cast<int>(std::labs(code)), text.data(), text.size());
  const std::string_view reason(text.data());
  return std::string(reason.substr(0, reason.find(" (")));  // without the number
}

IioContext open_iio_context(const std::string& uri) {
  errno = 0;
  return IioContext(iio_create_context_from_uri(uri.c_str()));
}

std::string iio_name(const iio_device* device) {
  const char* const name = iio_device_get_name(device);
  return name != nullptr ? name : iio_device_get_id(device);
}

std::optional<std::string> iio_text(const iio_device* device, const char* attribute) {
  if (iio_device_find_attr(device, attribute) == nullptr) return std::nullopt;
  std::array<char, 4096> text{};
  return trimmed(text, iio_device_attr_read(device, attribute, text.data(), text.size()));
}

std::optional<std::string> iio_text(const iio_channel* channel, const char* attribute) {
  if (iio_channel_find_attr(channel, attribute) == nullptr) return std::nullopt;
  std::array<char, 4096> text{};
  return trimmed(text, iio_channel_attr_read(channel, attribute, text.data(), text.size()));
}

std::vector<iio_device*> iio_devices(const iio_context* context, bool triggers) {
  std::vector<iio_device*> devices;
  for (unsigned k = 0; k < iio_context_get_devices_count(context); ++k) {
    iio_device* const device = iio_context_get_device(context, k);
    if (iio_device_is_trigger(device) == triggers) devices.push_back(device);
  }
  return devices;
}

std::string list_of(const std::vector<iio_device*>& devices) {
  std::string list;
  for (const iio_device* const device : devices) {
    const std::string name = iio_name(device), id = iio_device_get_id(device);
    list += (list.empty() ? "" : ", ") + (name == id ? id : name + " (" + id + ")");
  }
  return list.empty() ? "none" : list;
}

}  // namespace proofmass::acquire
