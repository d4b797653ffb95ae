#include "plots/figure.h"

#include <gtest/gtest.h>
#include <stdlib.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <system_error>

#include "plots/gnuplot.h"
#include "tests/plots/convergence_figure.h"

namespace liebench {
namespace {

namespace fs = std::filesystem;

class FigureFiles : public testing::Test {
 protected:
  void SetUp() override {
    const testing::TestInfo* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::temp_directory_path() /
              (std::string("liebench_figure_") + test->name() + "_" + std::to_string(getpid()));
    fs::create_directories(folder_);
    if (const char* program = getenv("LIEBENCH_GNUPLOT")) program_ = program;
  }
  void TearDown() override {
    fs::remove_all(folder_);
    setenv("LIEBENCH_GNUPLOT", program_.c_str(), 1);
  }

  static std::string read(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  std::ptrdiff_t file_count() const {
    return std::distance(fs::directory_iterator(folder_), fs::directory_iterator());
  }

  fs::path folder_;
  std::string program_;
};

TEST_F(FigureFiles, ComeInThreeFormats) {
  const std::array<fs::path, 3> outputs{folder_ / "a.svg", folder_ / "it's b.pdf", folder_ / "c.png"};
  draw(convergence_figure(), outputs);
  EXPECT_TRUE(contains(read(outputs[0]).substr(0, 200), "<svg"));
  EXPECT_TRUE(contains(read(outputs[0]), "λ"));
  EXPECT_TRUE(contains(read(outputs[0]), "font-family=\"sans-serif\""));
  EXPECT_TRUE(read(outputs[1]).starts_with("%PDF-"));
  EXPECT_TRUE(read(outputs[2]).starts_with("\x89PNG\r\n\x1a\n"));
  EXPECT_EQ(file_count(), 3);
}

TEST_F(FigureFiles, AreEqualForEqualFigures) {
  const std::array<fs::path, 3> first{folder_ / "a.svg", folder_ / "a.pdf", folder_ / "a.png"};
  const std::array<fs::path, 3> second{folder_ / "b.svg", folder_ / "b.pdf", folder_ / "b.png"};
  draw(convergence_figure(), first);
  // The clock of a PDF counts seconds.
  sleep(1);
  draw(convergence_figure(), second);
  for (std::size_t index = 0; index < first.size(); ++index) {
    EXPECT_EQ(read(first[index]), read(second[index])) << first[index];
  }
}

TEST_F(FigureFiles, AreDrawnWithoutDataToo) {
  Figure figure{.title = "empty"};
  figure.panels = {Panel{.x_label = "h", .y_label = "error"}};
  const std::array<fs::path, 1> outputs{folder_ / "empty.svg"};
  draw(figure, outputs);
  EXPECT_TRUE(contains(read(outputs[0]), "no data"));

  figure.panels[0].series = {Series{.label = "k = 2", .failures = {{.x = 1e-2}, {.x = 1e-3}}}};
  draw(figure, outputs);
  EXPECT_TRUE(contains(read(outputs[0]), "failed run"));
}

TEST_F(FigureFiles, SurviveTheEndsOfDouble) {
  Figure figure{.title = "extreme"};
  Panel panel;
  panel.series = {Series{.label = "extreme", .points = {{1e-300, 5e-324}, {1e-2, 1e-30}, {1e300, 1e308}}}};
  panel.orders = {{.order = 2}};
  figure.panels = {panel};
  panel.series[0].points = {{1e-2, 1e-3}};
  figure.panels.push_back(panel);
  panel.log_x = panel.log_y = false;
  figure.panels.push_back(panel);
  figure.columns = 3;
  const std::array<fs::path, 1> outputs{folder_ / "extreme.svg"};
  EXPECT_NO_THROW(draw(figure, outputs));
}

TEST_F(FigureFiles, WithUnknownEndingsAreRefusedBeforeAnyIsWritten) {
  const std::array<fs::path, 2> outputs{folder_ / "a.svg", folder_ / "a.jpg"};
  EXPECT_THROW(draw(convergence_figure(), outputs), std::invalid_argument);
  EXPECT_EQ(file_count(), 0);
}

TEST_F(FigureFiles, InAMissingFolderAreRefusedBeforeAnyIsWritten) {
  const std::array<fs::path, 2> outputs{folder_ / "a.svg", folder_ / "missing" / "a.pdf"};
  try {
    draw(convergence_figure(), outputs);
    FAIL() << "no exception";
  } catch (const std::system_error& error) {
    EXPECT_TRUE(contains(error.what(), outputs[1].string())) << error.what();
  }
  EXPECT_EQ(file_count(), 0);
}

TEST_F(FigureFiles, StayAsTheyWereWhenGnuplotFailsOrStopsHalfWay) {
  const std::array<fs::path, 1> outputs{folder_ / "a.svg"};
  std::ofstream(outputs[0]) << "old";
  // `true` ends well and writes nothing, as gnuplot does on a full disk.
  for (const char* program : {"true", "false"}) {
    setenv("LIEBENCH_GNUPLOT", program, 1);
    EXPECT_THROW(draw(convergence_figure(), outputs), GnuplotError) << program;
  }
  setenv("LIEBENCH_GNUPLOT", "/nowhere/gnuplot", 1);
  EXPECT_THROW(draw(convergence_figure(), outputs), GnuplotMissing);
  EXPECT_EQ(read(outputs[0]), "old");
  EXPECT_EQ(file_count(), 1);
}

}  // namespace
}  // namespace liebench
