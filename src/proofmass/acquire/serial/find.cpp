#include "proofmass/acquire/serial/find.hpp"

#include <algorithm>
#include <fcntl.h>
#include <fstream>
#include <linux/serial.h>
#include <set>
#include <string>
#include <sys/ioctl.h>
#include <unistd.h>

#include "proofmass/acquire/source_list.hpp"
#include "proofmass/io/shown_text.hpp"

namespace proofmass::acquire {
namespace {

namespace fs = std::filesystem;

/// Names in a folder, sorted; empty if it cannot be read.
std::vector<fs::path> entries_of(const fs::path& folder) {
  std::vector<fs::path> entries;
  std::error_code problem;
  for (fs::directory_iterator entry(folder, problem), end; !problem && entry != end;
       entry.increment(problem))
    entries.push_back(entry->path());
  std::ranges::sort(entries);
  return entries;
}

std::string first_line(const fs::path& file) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  return io::shown(line);
}

/// "Arduino SA Arduino Uno", from the USB device of a port; empty for others.
std::string usb_product(const fs::path& sys, const std::string& name) {
  std::error_code problem;
  fs::path at = fs::canonical(sys / "class" / "tty" / name / "device", problem);
  constexpr int deepest = 4;
  for (int level = 0; !problem && level < deepest && at.has_parent_path(); ++level) {
    if (const std::string product = first_line(at / "product"); !product.empty()) {
      const std::string maker = first_line(at / "manufacturer");
      return maker.empty() ? product : maker + ' ' + product;
    }
    at = at.parent_path();
  }
  return {};
}

/// Few of the ports that a PC always lists have a chip. Source: ttyS(4), setserial(8).
bool has_chip(const fs::path& port) {
  const int descriptor = ::open(port.c_str(), O_RDONLY | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) return false;
  serial_struct serial{};
  const bool answered = ::ioctl(descriptor, TIOCGSERIAL, &serial) == 0;
  ::close(descriptor);
  return answered && serial.type != PORT_UNKNOWN;
}

bool is_port(const fs::path& path) {
  const std::string name = path.filename();
  if (name.starts_with("ttyACM") || name.starts_with("ttyUSB") || name.starts_with("ttyAMA"))
    return true;
  return name.starts_with("ttyS") && has_chip(path);
}

}  // namespace

std::vector<FoundSource> serial_devices(const fs::path& dev, const fs::path& sys) {
  std::vector<FoundSource> found;
  std::set<fs::path> named;  // ports with a persistent name, which is preferred
  for (const fs::path& link : entries_of(dev / "serial" / "by-id")) {
    std::error_code problem;
    const fs::path port = fs::canonical(link, problem);
    if (problem) continue;
    named.insert(port);
    const std::string product = usb_product(sys, port.filename());
    found.push_back({"serial:" + link.string(),
                     (product.empty() ? "" : product + ", ") + port.filename().string()});
  }
  for (const fs::path& port : entries_of(dev)) {
    std::error_code problem;
    if (!is_port(port) || named.contains(fs::canonical(port, problem))) continue;
    const std::string product = usb_product(sys, port.filename());
    found.push_back({"serial:" + port.string(), product.empty() ? "serial port" : product});
  }
  return found;
}

Result<std::vector<FoundSource>> find_serial() {
  return serial_devices("/dev", "/sys");
}

}  // namespace proofmass::acquire
