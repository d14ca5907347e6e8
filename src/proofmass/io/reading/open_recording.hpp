#pragma once

#include <memory>
#include <string>

#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/io/read_recording.hpp"
#include "proofmass/io/reading/recording_reader.hpp"
#include "proofmass/io/table_file.hpp"

namespace proofmass::io {

/// Opens a file or a folder; "-" is standard input. Errors: those of the format, without the name.
[[nodiscard]] Result<std::unique_ptr<TableFile>> open_path(const std::string& path,
                                                           const ReadOptions& options);

/// The tables of the recording, all or those selected, and notes on the selection.
struct ChosenTables {
  std::vector<std::size_t> tables;
  std::vector<Note> notes;
};
/// Errors: those of choose_table(); invalid_argument (several tables with separate clocks, and no
/// rate to resample them at).
[[nodiscard]] Result<ChosenTables> chosen_tables_of(const TableFile& file,
                                                    const ReadOptions& options);

/// Reads them completely; several are joined on one grid, a single one is resampled if the options
/// require it. Errors: those of the readers.
[[nodiscard]] Result<Recording> read_tables(TableFile& file,
                                            const ChosenTables& chosen,
                                            const ReadOptions& options);

}  // namespace proofmass::io
