#include <iio.h>
#include <memory>
#include <sys/stat.h>
#include <thread>

#include "proofmass/acquire/iio/columns.hpp"
#include "proofmass/acquire/iio/handle.hpp"
#include "proofmass/acquire/source_list.hpp"

namespace proofmass::acquire {
namespace {

bool is_there(const char* path) {
  struct stat about{};
  return stat(path, &about) == 0;
}

void add_devices(const char* uri, std::vector<FoundSource>& found) {
  const IioContext context = open_iio_context(uri);
  if (!context) return;
  for (iio_device* const device : iio_devices(context.get(), false)) {
    const auto columns = choose_columns(device, {});
    if (!columns) continue;
    FoundSource source{std::string("iio:") + uri + "?device=" + iio_device_get_id(device),
                       iio_name(device) + ":"};
    for (const Channel& channel : columns->heads) source.what += " " + channel.name;
    source.what += "; triggers: " + list_of(iio_devices(context.get(), true));
    found.push_back(std::move(source));
  }
}

void scan(const char* backend, std::vector<FoundSource>& found) {
  iio_scan_context* const scan = iio_create_scan_context(backend, 0);
  if (scan == nullptr) return;
  iio_context_info** list = nullptr;
  const ssize_t count = iio_scan_context_get_info_list(scan, &list);
  for (ssize_t k = 0; k < count; ++k) add_devices(iio_context_info_get_uri(list[k]), found);
  if (count >= 0) iio_context_info_list_free(list);
  iio_scan_context_destroy(scan);
}

}  // namespace

Result<std::vector<FoundSource>> find_iio() {
  std::vector<FoundSource> found;
  std::thread([&] {
    block_broken_pipes();
    // libiio prints an error if there is nothing to search: it is called only if there is.
    if (is_there("/sys/bus/iio/devices")) scan("local", found);
    if (is_there("/run/avahi-daemon/socket")) scan("ip", found);
    if (is_there("/dev/bus/usb")) scan("usb", found);
  }).join();
  return found;
}

}  // namespace proofmass::acquire
