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

constexpr double width = 760, row_height = 26, title_height = 34, axis_height = 48;

// Between a bar and its note, pixels.
constexpr double gap = 6.0;

std::string bar_commands(const BarChart& chart, double height) {
  const BarLayout at = layout(chart);
  std::string script = fmt::format(
      "unset key\nset lmargin at screen {:.5f}\nset rmargin at screen {:.5f}\n"
      "set tmargin at screen {:.5f}\nset bmargin at screen {:.5f}\n",
      at.left / at.width, at.right / at.width, 1.0 - title_height / height, axis_height / height);
  script += fmt::format("set label 1000 {} at screen 0.5,{:.5f} center font ',{}'\n",
                        gnuplot_literal(plain_text(chart.title)), 1 - 16 / height, font_size + 1);
  script +=
      fmt::format("set xlabel {}\nset xrange [{}:{}]\nset yrange [{}:-0.5]\n",
                  gnuplot_literal(plain_text(chart.axis)), at.from, at.to, double(chart.bars.size()) - 0.5);
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
    script += fmt::format("set label {} {} at screen {:.5f}, first {} left\n", i + 1,
                          gnuplot_literal(plain_text(bar.note)),
                          (at.pixel(std::max(0.0, bar.value)) + gap) / at.width, i);
  }
  return script + "plot 1/0 notitle\n";
}

}  // namespace

BarLayout layout(const BarChart& chart) {
  double label_width = 0.0, least = 0.0;
  for (const Bar& bar : chart.bars) {
    label_width = std::max(label_width, text_width(bar.label));
    least = std::min(least, bar.value);
  }
  BarLayout at{
      .width = width, .left = label_width + 24.0, .right = width - 20.0, .from = 1.05 * least, .to = 0.0};
  for (const Bar& bar : chart.bars) {
    // A note that is as wide as the picture leaves a tenth for the bars.
    const double room = std::max(at.right - at.left - gap - text_width(bar.note), 0.1 * (at.right - at.left));
    const double end = std::max(0.0, bar.value) - at.from;
    at.to = std::max(at.to, at.from + end * (at.right - at.left) / room);
  }
  if (at.to <= 0.0) at.to = at.from < 0.0 ? -at.from : 1.0;
  return at;
}

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
