#include "plots/figure.h"

#include "plots/drawing.h"
#include "plots/gnuplot_script.h"

namespace liebench {

void draw(const Figure& figure, std::span<const std::filesystem::path> outputs) {
  // Refuse a wrong ending or figure before any file is made.
  require_drawable(figure, outputs);
  draw_files(outputs, [&](std::span<const std::filesystem::path> temporaries) {
    return gnuplot_script(figure, outputs, temporaries);
  });
}

}  // namespace liebench
