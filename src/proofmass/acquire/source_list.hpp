#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "proofmass/acquire/source.hpp"
#include "proofmass/acquire/source_uri.hpp"

namespace proofmass::acquire {

/// A kind of source and its open function.
struct SourceEntry {
  SourceKind kind;
  std::function<Result<std::unique_ptr<Source>>(SourceUri& uri, const OpenOptions& options)> open;
};

/// The list of sources. To add a source, add a line.
[[nodiscard]] std::vector<SourceEntry> source_entries();

// One function per line, each in its source's file.
[[nodiscard]] Result<std::unique_ptr<Source>> open_daqmx(SourceUri& uri,
                                                         const OpenOptions& options);
/// Uses the driver in `library`, or the system's if it is empty.
[[nodiscard]] Result<std::vector<FoundSource>> find_daqmx(const std::string& library);
[[nodiscard]] Result<std::unique_ptr<Source>> open_replay(SourceUri& uri,
                                                          const OpenOptions& options);
[[nodiscard]] Result<std::unique_ptr<Source>> open_iio(SourceUri& uri, const OpenOptions& options);
[[nodiscard]] Result<std::vector<FoundSource>> find_iio();
[[nodiscard]] Result<std::unique_ptr<Source>> open_comedi(SourceUri& uri,
                                                          const OpenOptions& options);
[[nodiscard]] Result<std::vector<FoundSource>> find_comedi();
[[nodiscard]] Result<std::unique_ptr<Source>> open_sim(SourceUri& uri, const OpenOptions& options);
[[nodiscard]] Result<std::vector<FoundSource>> find_sim();
[[nodiscard]] Result<std::unique_ptr<Source>> open_serial(SourceUri& uri,
                                                          const OpenOptions& options);
[[nodiscard]] Result<std::vector<FoundSource>> find_serial();
[[nodiscard]] Result<std::unique_ptr<Source>> open_stdin(SourceUri& uri,
                                                         const OpenOptions& options);
[[nodiscard]] Result<std::unique_ptr<Source>> open_udp(SourceUri& uri, const OpenOptions& options);
[[nodiscard]] Result<std::unique_ptr<Source>> open_mqtt(SourceUri& uri, const OpenOptions& options);
[[nodiscard]] Result<std::unique_ptr<Source>> open_phyphox(SourceUri& uri,
                                                           const OpenOptions& options);
[[nodiscard]] Result<std::unique_ptr<Source>> open_sensor_server(SourceUri& uri,
                                                                 const OpenOptions& options);

}  // namespace proofmass::acquire
