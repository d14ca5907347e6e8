#pragma once

#include <string>
#include <utility>
#include <vector>

// Writes LabVIEW measurement files for tests.
namespace proofmass::io::specimen {

struct LvmFileHeader {
  std::string x_columns = "No";
  std::string time_pref = "Relative";
  char separator = '\t';
  std::string separator_name = "Tab";
  std::string decimal_separator = ".";  ///< empty: not given, as before version 2
};

/// A text written with tabs, with the file's separator.
inline std::string with(std::string text, char separator) {
  for (char& c : text)
    if (c == '\t') c = separator;
  return text;
}

inline std::string lvm_header(const LvmFileHeader& h = {}) {
  std::string out = "LabVIEW Measurement\t\nWriter_Version\t2\nReader_Version\t2\nSeparator\t" +
                    h.separator_name + "\n";
  if (!h.decimal_separator.empty()) out += "Decimal_Separator\t" + h.decimal_separator + "\n";
  out += "Multi_Headings\tYes\nX_Columns\t" + h.x_columns + "\nTime_Pref\t" + h.time_pref +
         "\nOperator\tme\nDate\t2024/03/01\nTime\t12:00:00.5\n***End_of_Header***\t\n\t\n";
  return with(out, h.separator);
}

/// A segment's header of equal channels, with the given tags and column names.
struct LvmSegmentText {
  std::vector<std::string> names{"a", "b"};
  std::vector<std::string> units{"g", "V"};
  std::string time = "12:00:01";
  std::string samples = "3";
  std::vector<std::string> x0{"0", "0"};
  std::vector<std::string> delta_x{"0.01", "0.01"};
  bool is_multi = false;  ///< an X column for each channel
  bool has_names = true;
  char separator = '\t';
};

inline std::string lvm_segment(const LvmSegmentText& s, const std::string& rows) {
  const std::string gap = s.is_multi ? "\t\t" : "\t";
  const auto line = [&](const std::string& tag, const std::vector<std::string>& values) {
    std::string out = tag;
    for (std::size_t i = 0; i < values.size(); ++i) out += (i == 0 ? "\t" : gap) + values[i];
    return out + "\t\n";
  };
  const auto same = [&](const std::string& value) {
    return std::vector<std::string>(s.names.size(), value);
  };
  std::string out = "Channels\t" + std::to_string(s.names.size()) + "\t\t\n" +
                    line("Samples", same(s.samples)) + line("Date", same("2024/03/01")) +
                    line("Time", same(s.time)) + line("Y_Unit_Label", s.units) +
                    line("X_Dimension", same("Time")) + line("X0", s.x0) +
                    line("Delta_X", s.delta_x) + "***End_of_Header***\t\t\t\n";
  if (s.has_names) {
    std::string names = "X_Value";
    for (std::size_t i = 0; i < s.names.size(); ++i)
      names += (s.is_multi && i > 0 ? "\tX_Value\t" : "\t") + s.names[i];
    out += names + "\tComment\n";
  }
  return with(out + rows, s.separator);
}

}  // namespace proofmass::io::specimen
