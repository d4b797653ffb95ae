#include "plots/curve_tags.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "plots/edge_marks.h"
#include "plots/style.h"

namespace liebench {
namespace {

constexpr double tag_distance = 8;   // from the end of the curve
constexpr double tag_height = 8;     // of one in a column
constexpr double column_width = 12;  // tags farther apart do not meet
constexpr double edge = 5;           // least distance of a tag's middle from the edge

/// The end of a curve and the direction in which it arrives there.
std::optional<CurveTag> at_the_end(const Series& series, const Axes& axes) {
  std::optional<Point> last, before;
  for (const Point& point : series.points) {
    if (place_of(point, axes) != Place::inside) continue;
    const Point on_page{axes.x.position(point.x), axes.y.position(point.y)};
    if (last && std::abs(on_page.x - last->x) > 1) before = last;
    last = on_page;
  }
  if (!last) return std::nullopt;
  const double direction = before && before->x > last->x ? -1 : 1;
  return CurveTag{.at = {std::clamp(last->x + direction * tag_distance, edge, axes.x.length - edge), last->y},
                  .text = series.tag,
                  .colour = colour_of(series)};
}

/// Moves the tags of a column apart, all together as little as possible (least squares): what overlaps becomes a block about
/// the mean of its places.
void spread(std::vector<CurveTag*>& column, double height) {
  std::ranges::stable_sort(column, {}, [](const CurveTag* tag) { return tag->at.y; });
  struct Block {
    double sum;  // of the places for its lowest tag that its tags ask for
    std::size_t size;
    double lowest() const { return sum / double(size); }
  };
  std::vector<Block> blocks;
  for (const CurveTag* tag : column) {
    blocks.push_back({tag->at.y, 1});
    while (blocks.size() > 1) {
      const Block upper = blocks.back();
      Block& lower = blocks[blocks.size() - 2];
      const double shift = tag_height * double(lower.size);
      if (lower.lowest() + shift <= upper.lowest()) break;
      lower.sum += upper.sum - shift * double(upper.size);
      lower.size += upper.size;
      blocks.pop_back();
    }
  }
  double least = edge;
  std::size_t next = 0;
  for (const Block& block : blocks)
    for (std::size_t i = 0; i < block.size; ++i) {
      CurveTag* tag = column[next++];
      tag->at.y = std::max(block.lowest() + tag_height * double(i), least);
      least = tag->at.y + tag_height;
    }
  double most = height - edge;
  for (std::size_t i = column.size(); i-- > 0;) {
    column[i]->at.y = std::min(column[i]->at.y, most);
    most = column[i]->at.y - tag_height;
  }
}

}  // namespace

std::vector<CurveTag> place_tags(const Panel& panel, const Axes& axes) {
  std::vector<CurveTag> tags;
  for (const Series& series : panel.series) {
    if (series.tag.empty()) continue;
    if (auto tag = at_the_end(series, axes)) tags.push_back(std::move(*tag));
  }
  std::vector<CurveTag*> by_place;
  for (CurveTag& tag : tags) by_place.push_back(&tag);
  std::ranges::stable_sort(by_place, {}, [](const CurveTag* tag) { return tag->at.x; });
  std::vector<CurveTag*> column;
  for (CurveTag* tag : by_place) {
    if (!column.empty() && tag->at.x - column.back()->at.x > column_width) {
      spread(column, axes.y.length);
      column.clear();
    }
    column.push_back(tag);
  }
  spread(column, axes.y.length);
  return tags;
}

}  // namespace liebench
