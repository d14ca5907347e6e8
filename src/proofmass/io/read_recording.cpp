#include "proofmass/io/read_recording.hpp"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <iterator>
#include <new>

#include "proofmass/io/bytes/byte_source.hpp"
#include "proofmass/io/formats.hpp"
#include "proofmass/io/layouts/tables.hpp"
#include "proofmass/io/reading/finish_recording.hpp"
#include "proofmass/io/reading/open_recording.hpp"

namespace proofmass::io {
namespace {

Result<Recording> read_table(TableFile& file, std::size_t table, const ReadOptions& options) {
  auto reader = file.open(table, options);
  if (!reader) return reader.error();
  auto read = read_whole(**reader, options);
  if (!read || !options.resample) return read;
  return signal::resample(*read, *options.resample);
}

/// Several tables have separate clocks.
Result<Recording> read_joined(TableFile& file,
                              const std::vector<std::size_t>& chosen,
                              const ReadOptions& options) {
  ReadOptions as_it_is = options;
  as_it_is.resample.reset();
  std::vector<Recording> parts;
  for (const std::size_t table : chosen) {
    const std::string& name = file.tables()[table].name;
    auto part = read_table(file, table, as_it_is);
    if (!part) return part.error().at(name);
    parts.push_back(std::move(part).value());
    parts.back().source = name;
  }
  return signal::join(parts, *options.resample);
}

}  // namespace

Result<std::unique_ptr<TableFile>> open_path(const std::string& path, const ReadOptions& options) {
  std::error_code problem;
  if (path != "-" && std::filesystem::is_directory(path, problem)) {
    auto folder = open_folder(path);
    if (!folder) return folder.error();
    return open_tables_in(std::move(folder).value(), options);
  }
  auto bytes = open_file(path);
  if (!bytes) return bytes.error();
  return open_tables(std::move(bytes).value(), path, options);
}

Result<ChosenTables> chosen_tables_of(const TableFile& file, const ReadOptions& options) {
  ChosenTables chosen{{0}, {}};
  const auto tables = file.tables();
  const bool is_named = !tables.empty() && !tables.front().name.empty();
  if (tables.size() == 1 && (options.variables.empty() || !is_named)) return chosen;
  auto choice = choose_table(file.tables(), options, chosen.notes);
  if (!choice) return choice.error();
  chosen.tables = std::move(choice).value();
  if (chosen.tables.size() > 1 && !options.resample)
    return Error{
        Errc::invalid_argument,
        fmt::format("{} and {} have each a clock of their own: name one of them, or "
                    "resample them to a common rate",
                    file.tables()[chosen.tables[0]].name, file.tables()[chosen.tables[1]].name),
        {Advice{"resample"}}};
  return chosen;
}

Result<Recording> read_tables(TableFile& file,
                              const ChosenTables& chosen,
                              const ReadOptions& options) {
  auto read = chosen.tables.size() > 1 ? read_joined(file, chosen.tables, options)
                                       : read_table(file, chosen.tables.front(), options);
  if (!read) return read.error();
  Recording recording = std::move(read).value();
  recording.notes.insert(recording.notes.begin(), chosen.notes.begin(), chosen.notes.end());
  return recording;
}

namespace {

Result<Recording> read_from(Result<std::unique_ptr<TableFile>> opened,
                            const std::string& name,
                            const ReadOptions& options) {
  const std::string shown = name == "-" ? "standard input" : name;
  if (!opened) return opened.error().at(shown);
  const auto chosen = chosen_tables_of(**opened, options);
  if (!chosen) return chosen.error().at(shown);
  auto read = read_tables(**opened, *chosen, options);
  if (!read) return read.error().at(shown);
  Recording recording = std::move(read).value();
  recording.source = name;
  return recording;
}

}  // namespace

Result<Recording> read_recording(const std::string& path, const ReadOptions& options) try {
  return read_from(open_path(path, options), path, options);
} catch (const std::bad_alloc&) {
  return Error{Errc::unreadable, "does not fit into memory: cut it, or choose channels"}.at(path);
}

Result<Recording> read_recording(std::span<const std::byte> bytes,
                                 const std::string& name,
                                 const ReadOptions& options) {
  return read_from(open_tables(open_memory(bytes), name, options), name, options);
}

}  // namespace proofmass::io
