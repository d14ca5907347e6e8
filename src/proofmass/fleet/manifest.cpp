#include "proofmass/fleet/manifest.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>

#include "proofmass/io/parquet/table.hpp"

namespace proofmass::fleet {
namespace {

namespace fs = std::filesystem;
using Table = std::vector<std::vector<std::string>>;  // the first row names the columns

Result<std::string> text_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return Error{Errc::unreadable, path + ": cannot be opened: check the manifest's name"};
  std::string text{std::istreambuf_iterator<char>(file), {}};
  if (text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);
  return text;
}

std::string json_field(const nlohmann::ordered_json& value) {
  if (value.is_null()) return {};
  return value.is_string() ? value.get<std::string>() : value.dump();
}

Result<Table> ndjson_table(const std::string& text) {
  Table table(1);
  std::map<std::string, std::size_t> places;
  std::size_t number = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string line = text.substr(begin, end - begin);
    begin = end + 1;
    ++number;
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    const auto object = nlohmann::ordered_json::parse(line, nullptr, false);
    if (!object.is_object())
      return Error{Errc::corrupt, fmt::format("line {}: expected one JSON object a line", number)};
    std::vector<std::string> row(table.front().size());
    for (const auto& [name, value] : object.items()) {
      const auto [place, is_new] = places.try_emplace(name, table.front().size());
      if (is_new) table.front().push_back(name);
      row.resize(table.front().size());
      row[place->second] = json_field(value);
    }
    table.push_back(std::move(row));
  }
  for (auto& row : table) row.resize(table.front().size());
  return table;
}

Result<Table> table_of(const std::string& path, const std::string& duckdb_library) {
  const std::string ending = fs::path(path).extension().string();
  if (ending == ".parquet") {
    const auto csv = io::parquet::as_csv(path, duckdb_library);
    if (!csv) return csv.error();
    return csv_fields(*csv);
  }
  const auto text = text_of(path);
  if (!text) return text.error();
  auto table = ending == ".ndjson" || ending == ".jsonl" ? ndjson_table(*text) : csv_fields(*text);
  if (!table) return table.error().at(path);
  return table;
}

bool is_beside_recordings(const fs::path& path) {
  const std::string name = path.filename().string();
  if (name.starts_with('.') || name.starts_with("manifest.")) return true;
  for (const char* ending : {".truth.csv", ".json", ".ndjson", ".html", ".toml", ".md", ".part",
                             ".pyramid.npz", ".log", ".png", ".svg", ".pdf"})
    if (name.ends_with(ending)) return true;
  return false;
}

// What --into has made, which may lie beside the recordings.
bool holds_results(const fs::path& folder) {
  std::error_code problem;
  for (fs::directory_iterator at(folder, problem), end; !problem && at != end;
       at.increment(problem)) {
    const std::string name = at->path().filename().string();
    if (name.starts_with("journal") && name.ends_with(".ndjson")) return true;
  }
  return false;
}

Result<std::vector<Job>> jobs_of_folder(const std::string& folder) {
  std::vector<std::string> files;
  std::error_code problem;
  for (fs::recursive_directory_iterator at(folder, problem), end; !problem && at != end;
       at.increment(problem)) {
    const bool hidden = at->path().filename().string().starts_with('.');
    if (at->is_directory(problem) && (hidden || holds_results(at->path())))
      at.disable_recursion_pending();
    if (at->is_regular_file(problem) && !is_beside_recordings(at->path()))
      files.push_back(at->path().string());
  }
  if (problem) return Error{Errc::unreadable, folder + ": " + problem.message()};
  std::ranges::sort(files);
  std::vector<Job> jobs;
  for (std::string& file : files) jobs.push_back({std::move(file), {}, {}});
  if (jobs.empty())
    return Error{Errc::invalid_argument, folder + ": there is no recording in this folder"};
  return jobs;
}

std::string opened_path(const std::string& path, const fs::path& manifest) {
  if (path.find("://") != std::string::npos || fs::path(path).is_absolute()) return path;
  return (manifest.parent_path() / path).lexically_normal().string();
}

Result<Job> job_of(const Table& table,
                   std::size_t row,
                   std::size_t path_column,
                   const std::string& manifest) {
  Job job;
  for (std::size_t k = 0; k < table.front().size(); ++k) {
    const std::string& value = table[row][k];
    if (k == path_column) {
      job.path = opened_path(value, manifest);
    } else if (table.front()[k] == "flags") {
      auto words = shell_words(value);
      if (!words) return words.error();
      job.flags = std::move(words).value();
    } else {
      job.columns.emplace_back(table.front()[k], value);
    }
  }
  if (table[row][path_column].empty())
    return Error{Errc::corrupt, fmt::format("row {}: no path", row)};
  return job;
}

}  // namespace

std::string_view manifest_field(const ManifestFields& fields, std::string_view name) {
  for (const auto& [key, value] : fields)
    if (key == name) return value;
  return {};
}

std::string Job::id() const {
  std::string text = path;
  for (const std::string& flag : flags) text += '\n' + flag;
  return text;
}

namespace {

// The rows of a table, character by character (RFC 4180, with any separator).
class TableRows {
 public:
  explicit TableRows(char separator) : separator_(separator) {}

  /// `next`: the character after it, 0 at the end. Returns whether that was taken, too.
  bool take(char c, char next) {
    if (c == '"' && quoted_ && next == '"') {
      row_.back() += c;
      return true;
    }
    if (c == '"' && (quoted_ || row_.back().empty()))
      quoted_ = !quoted_;
    else if (quoted_)
      row_.back() += c;
    else
      take_plain(c);
    return false;
  }

  void end_row() {
    if (row_.size() > 1 || !row_.front().empty()) table_.push_back(std::move(row_));
    row_.assign(1, {});
  }
  [[nodiscard]] bool is_quoted() const { return quoted_; }
  Table finish() {
    end_row();
    return std::move(table_);
  }

 private:
  void take_plain(char c) {
    if (c == separator_)
      row_.emplace_back();
    else if (c == '\n')
      end_row();
    else if (c != '\r')
      row_.back() += c;
  }

  char separator_;
  Table table_;
  std::vector<std::string> row_ = std::vector<std::string>(1);
  bool quoted_ = false;
};

char separator_of(std::string_view head) {
  char separator = ',';
  for (const char candidate : {';', '\t'})
    if (std::ranges::count(head, candidate) > std::ranges::count(head, separator))
      separator = candidate;
  return separator;
}

}  // namespace

Result<std::vector<std::vector<std::string>>> csv_fields(std::string_view text) {
  TableRows rows(separator_of(text.substr(0, text.find('\n'))));
  for (std::size_t k = 0; k < text.size(); ++k)
    if (rows.take(text[k], k + 1 < text.size() ? text[k + 1] : '\0')) ++k;
  if (rows.is_quoted()) return Error{Errc::corrupt, "a quote is opened and not closed"};
  const Table table = rows.finish();
  for (std::size_t k = 1; k < table.size(); ++k)
    if (table[k].size() != table.front().size())
      return Error{Errc::corrupt, fmt::format("row {}: {} fields, but the head has {}", k,
                                              table[k].size(), table.front().size())};
  return table;
}

Result<std::vector<std::string>> shell_words(std::string_view text) {
  std::vector<std::string> words;
  bool inside = false;
  char quote = '\0';
  for (std::size_t k = 0; k < text.size(); ++k) {
    const char c = text[k];
    const bool blank = c == ' ' || c == '\t' || c == '\n';
    if (quote == '\0' && blank) {
      inside = false;
      continue;
    }
    if (!inside) words.emplace_back();
    inside = true;
    if (quote == '\0' && (c == '"' || c == '\'')) {
      quote = c;
    } else if (c == quote) {
      quote = '\0';
    } else if (c == '\\' && quote != '\'' && k + 1 < text.size()) {
      words.back() += text[++k];
    } else {
      words.back() += c;
    }
  }
  if (quote != '\0') return Error{Errc::corrupt, fmt::format("flags: {} is not closed", quote)};
  return words;
}

std::vector<std::string> merged_flags(const std::vector<std::string>& common,
                                      const std::vector<std::string>& own) {
  const auto name_of = [](const std::string& word) { return word.substr(0, word.find('=')); };
  const auto is_flag = [](const std::string& word) {
    return word.size() > 1 && word[0] == '-' &&
           std::isdigit(static_cast<unsigned char>(word[1])) == 0 && word[1] != '.';
  };
  std::vector<std::string> merged;
  bool replaced = false;
  for (const std::string& word : common) {
    if (is_flag(word))
      replaced = std::ranges::any_of(own, [&](const std::string& other) {
        return is_flag(other) && name_of(other) == name_of(word);
      });
    if (!replaced) merged.push_back(word);
  }
  merged.insert(merged.end(), own.begin(), own.end());
  return merged;
}

std::vector<Job> shard_of(const std::vector<Job>& jobs, std::size_t i, std::size_t n) {
  std::vector<Job> shard;
  for (std::size_t k = i; k < jobs.size(); k += n) shard.push_back(jobs[k]);
  return shard;
}

Result<std::vector<Job>> read_manifest(const std::string& path, const std::string& duckdb_library) {
  std::error_code problem;
  if (fs::is_directory(path, problem)) return jobs_of_folder(path);
  const auto read = table_of(path, duckdb_library);
  if (!read) return read.error();
  const Table& table = *read;
  const auto bad = [&](std::string what) {
    return Error{Errc::invalid_argument, path + ": " + std::move(what)};
  };
  if (table.empty()) return bad("is empty: expected a table with a column path");
  const auto& head = table.front();
  const auto found = std::ranges::find_if(
      head, [](const std::string& name) { return name == "path" || name == "file"; });
  if (found == head.end())
    return bad("has no column path: name the column with the recordings' files so");
  if (table.size() < 2) return bad("lists no recording");
  const auto column = static_cast<std::size_t>(found - head.begin());
  std::vector<Job> jobs;
  std::map<std::string, std::size_t> seen;
  for (std::size_t row = 1; row < table.size(); ++row) {
    auto job = job_of(table, row, column, path);
    if (!job) return job.error().at(path);
    const auto [first, is_new] = seen.try_emplace(job->id(), row);
    if (!is_new)
      return bad(fmt::format("row {}: {} is in row {} already, with the same flags", row, job->path,
                             first->second));
    jobs.push_back(std::move(job).value());
  }
  return jobs;
}

}  // namespace proofmass::fleet
