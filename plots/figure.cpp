#include "plots/figure.h"

#include <fmt/format.h>

#include <fstream>
#include <iterator>

#include "plots/gnuplot.h"
#include "plots/gnuplot_script.h"

namespace liebench {
namespace {

// gnuplot says nothing when the disk is full; a file that lacks its end tells.
void finish(const PendingFile& file) {
  std::ifstream input(file.temporary(), std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(input), std::istreambuf_iterator<char>()};
  input.close();
  const std::string ending = file.target().extension().string();
  const std::string_view mark = ending == ".svg" ? "</svg>" : ending == ".pdf" ? "%%EOF" : "IEND";
  const std::size_t found = bytes.rfind(mark);
  if (found == std::string::npos || found + mark.size() + 8 < bytes.size()) {
    throw GnuplotError(fmt::format("gnuplot did not finish '{}' ({} bytes); is the disk full?",
                                   file.target().string(), bytes.size()));
  }
  if (ending != ".pdf") return;

  // cairo 1.16 writes the time of day and honours no SOURCE_DATE_EPOCH. Equal length: the PDF's table of
  // offsets stays right.
  constexpr std::string_view key = "/CreationDate (D:";
  constexpr std::string_view epoch = "19700101000000";
  const std::size_t date = bytes.rfind(key);
  if (date == std::string::npos || date + key.size() + epoch.size() > bytes.size()) return;
  std::fstream output(file.temporary(), std::ios::binary | std::ios::in | std::ios::out);
  output.seekp(static_cast<std::streamoff>(date + key.size()));
  output << epoch;
  output.close();
  if (!output) throw GnuplotError(fmt::format("cannot rewrite the date of '{}'", file.target().string()));
}

}  // namespace

void draw(const Figure& figure, std::span<const std::filesystem::path> outputs) {
  // Refuse a wrong ending or figure before any file is made.
  require_drawable(figure, outputs);
  std::vector<PendingFile> files;
  files.reserve(outputs.size());
  std::vector<std::filesystem::path> temporaries;
  for (const std::filesystem::path& output : outputs) {
    files.emplace_back(output);
    temporaries.push_back(files.back().temporary());
  }
  run_gnuplot(gnuplot_script(figure, outputs, temporaries));
  for (const PendingFile& file : files) finish(file);
  for (PendingFile& file : files) file.commit();
}

}  // namespace liebench
