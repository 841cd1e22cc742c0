// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace armature {
namespace plot ARMATURE_EXPORT {

/// How a curve looks, and what it is called in the legend.
struct Line {
  std::string name;
  std::string stroke;    // attributes of SVG
  bool is_dots = false;  // points alone, not joined
};

/// Of the `i`-th of several curves: Okabe and Ito's colours, which colour-blind readers tell apart,
/// and a grey; from the eighth on they come again, dashed.
Line line_of(std::size_t i, std::string name);
/// In the colour of the `i`-th, dashed.
Line dashed_line(std::size_t i, std::string name);
/// In the colour of the `i`-th, points that are not joined.
Line dots_of(std::size_t i, std::string name);
/// Of one that stands for itself.
Line black_line(std::string name);

struct Axis {
  std::string label;  // with the unit: "time [s]"
  bool is_logarithmic = false;
  double min_span = 0;  // less is noise; of a logarithmic one the least value that is told apart
};

/// Values over those of x; a value that is NaN is a gap.
struct Curve {
  std::size_t in_legend;
  std::vector<double> x, y;
};

/// Curves of one quantity in a frame of their own. The label of its axis stands above it.
struct Panel {
  Axis y;
  std::vector<Curve> curves;
};

struct Chart {
  std::string title;
  std::vector<Line> legend;
  Axis x;                     // of all panels
  std::vector<Panel> panels;  // under each other
  bool is_equal = false;      // x and y to the same scale: of places
};

/// As an SVG text: sharp at any size, and every browser shows it. A panel without any value is
/// left out.
std::string to_svg(const Chart& chart);

}  // namespace plot
}  // namespace armature
