#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "harness/record_row.h"
#include "plots/figure.h"

// The figures of Wieloch & Arnold's paper, and those in their manner for the other methods: which study feeds which
// panels.

namespace liebench {

// A figure of the main job. Its records come from studies of its own name, compiled into the program.
struct PaperFigure {
  std::string_view name;
  std::vector<std::string_view> studies;  // files in harness/studies
  bool timed = false;                     // its runs in double are timed, too
  std::vector<std::string_view>
      outside_studies{};  // of solvers that this program may have been built without
};

// Figures 1 to 4 of the paper, then the others, in this order.
const std::vector<PaperFigure>& paper_figures();

// Pictures of a figure by file name: Figure 1 gives figure1 for k = 2 as in the paper and figure1_k3,
// figure1_k4 beside it.
std::map<std::string, Figure> draw_paper_figure(const PaperFigure& figure,
                                                const std::vector<RecordRow>& records);

}  // namespace liebench
