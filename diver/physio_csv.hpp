// Recordings from .csv files: columns of numbers under a heading, with or without a column of time.
// Pure functions of the text; any thread.
#pragma once

#include <optional>

#include "diver/physio_recording.hpp"

namespace neritic::diver {

// Shared by all tables of this folder: cells of a line without blanks and quotes; a file without
// the mark that spreadsheets begin it with; by semicolon where the heading has one and no comma, by
// comma or semicolon where it has a comma, else tab.
std::string_view trimmed_cell(std::string_view text);
std::vector<std::string_view> csv_cells(std::string_view line, const char* separators);
std::string_view without_mark(std::string_view text);
const char* separators_of(std::string_view heading);
// A number of these cells, if it is one and no more. Where only semicolons part them, a comma is a
// decimal point, as spreadsheets of many countries write it: 30,5 is 30.5.
std::optional<double> number_of(std::string_view cell, const char* separators);
// An addition to "N cells expected", where commas part cells that decimal commas may have cut.
std::string_view decimal_comma_words(std::size_t cells, std::size_t width, const char* separators);
// The column of time among names in small letters (SampleTable::time_column).
std::optional<std::size_t> time_column_of(const std::vector<std::string>& names, double& scale);

// Columns by name, parted by commas, semicolons (then decimal commas count) or tabs; an empty cell,
// or one without a number, is NaN. '#' starts a comment; one that says fs_hz=1000 (or rate_hz=)
// gives the rate. In columns 'status' and 'valid' words count: true, yes, valid, ok are 1, false,
// no, invalid, lost are 0, and any other is an error.
struct SampleTable {
  std::vector<std::string> names;
  std::vector<std::vector<double>> columns;  // all of one length
  std::vector<std::uint32_t> lines;          // of the file, from 1: where each row is
  std::vector<bool> words;                   // of each column: no number in it, and some words
  std::optional<double> rate_hz;

  std::optional<std::size_t> find(std::string_view name) const;
  // The column of time: 't' (t_s, "t (s)") or a word that starts with time; scale gives seconds (of
  // ms, us, ns and min too: time_ms, "time (ms)", "time [ms]").
  std::optional<std::size_t> time_column(double& scale) const;
};
// kBadInput names file and line. At least one row; a heading is required.
Result<SampleTable> parse_sample_table(std::string_view text, const std::string& name);

struct CsvChannel {
  std::string column;    // empty: the first of numbers that is not time, and does not count rows
  double rate_hz = 0.0;  // 0: from the column of time, else from the comment
};
// One column, evenly spaced. The rate is that of the steps of usual length, to six digits; stamps
// may jitter. If the time leaps, the samples between are missing and counted; rows whose time
// goes back by most of a step or more are refused and counted, and so are rows whose time stands
// still, unless the rate is given: then they are of one packet. A column of words is an error.
Result<Recording> parse_csv(std::string_view text, const std::string& name,
                            const CsvChannel& channel);

}  // namespace neritic::diver
