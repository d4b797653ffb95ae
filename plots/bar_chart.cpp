#include "plots/bar_chart.h"

#include <fmt/format.h>

#include <algorithm>

#include "plots/drawing.h"
#include "plots/figure.h"
#include "plots/gnuplot_script.h"
#include "plots/style.h"
#include "plots/text.h"

namespace liebench {

namespace {

constexpr double width = 540, row_height = 26, title_height = 34, axis_height = 48;

std::string bar_commands(const BarChart& chart, double height) {
  double label_width = 0.0, least = 0.0, most = 0.0;
  for (const Bar& bar : chart.bars) {
    label_width = std::max(label_width, text_width(bar.label));
    least = std::min(least, bar.value);
    most = std::max(most, bar.value);
  }
  if (most == least) most = 1.0;
  const double room = 0.25 * (most - least);
  std::string script = fmt::format(
      "unset key\nset lmargin at screen {:.5f}\nset rmargin at screen {:.5f}\n"
      "set tmargin at screen {:.5f}\nset bmargin at screen {:.5f}\n",
      (label_width + 24.0) / width, 1.0 - 20.0 / width, 1.0 - title_height / height, axis_height / height);
  script += fmt::format("set label 1000 {} at screen 0.5,{:.5f} center font ',{}'\n",
                        gnuplot_literal(plain_text(chart.title)), 1 - 16 / height, font_size + 1);
  script += fmt::format("set xlabel {}\nset xrange [{}:{}]\nset yrange [{}:-0.5]\n",
                        gnuplot_literal(plain_text(chart.axis)), least < 0.0 ? least - 0.2 * room : 0.0,
                        most + room, double(chart.bars.size()) - 0.5);
  script +=
      "set border 3 linecolor '#808080'\nset xtics nomirror textcolor '#000000'\nset ytics nomirror scale 0 "
      "textcolor '#000000' (";
  for (std::size_t i = 0; i < chart.bars.size(); ++i)
    script += fmt::format("{}{} {}", i == 0 ? "" : ", ", gnuplot_literal(plain_text(chart.bars[i].label)), i);
  script += ")\nset arrow 1000 from 0,graph 0 to 0,graph 1 nohead linecolor '#808080'\n";
  for (std::size_t i = 0; i < chart.bars.size(); ++i) {
    const Bar& bar = chart.bars[i];
    script += fmt::format(
        "set object {} rectangle from {},{} to {},{} fillstyle solid noborder fillcolor '#0072b2'\n", i + 1,
        std::min(0.0, bar.value), double(i) - 0.33, std::max(0.0, bar.value), double(i) + 0.33);
    // Beside what a bar to the left leaves free.
    script += fmt::format("set label {} {} at {},{} left offset 0.6,0\n", i + 1,
                          gnuplot_literal(plain_text(bar.note)), std::max(0.0, bar.value), i);
  }
  return script + "plot 1/0 notitle\n";
}

}  // namespace

void draw(const BarChart& chart, const std::filesystem::path& output) {
  const double height = title_height + axis_height + row_height * double(chart.bars.size());
  const std::string terminal = terminal_commands(output, width, height);
  draw_files(std::span(&output, 1), [&](std::span<const std::filesystem::path> temporaries) {
    return "set encoding utf8\nset samples 2\n" + terminal +
           fmt::format("set output {}\n", gnuplot_literal(temporaries.front().string())) +
           bar_commands(chart, height) + "unset output\n";
  });
}

}  // namespace liebench
