// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "envelope.hpp"

namespace armature::report::joints {

/// Curves of one quantity in a frame of their own.
struct Panel {
  std::string title;    // with the unit
  bool is_logarithmic;  // of what goes down over powers of ten
  double min_span;      // of the axis: less is noise
  struct Curve {
    std::size_t in_envelope;
    std::size_t in_legend;
  };
  std::vector<Curve> curves;
};

/// How a curve looks, and what it is called in the legend.
struct Line {
  std::string name, stroke;
};

/// Of the `i`-th of several curves: Okabe and Ito's colours, which colour-blind readers tell apart,
/// and a grey; from the eighth on they come again, dashed.
Line line_of(std::size_t i, std::string name);
/// Of one that stands for itself.
Line black_line(std::string name);

/// Panels under each other over one axis of time, as an SVG text: sharp at any size, and every
/// browser shows it. A panel without any value is left out.
std::string to_svg(const std::string& title, const std::vector<Line>& legend,
                   const std::vector<Panel>& panels, const Envelope& envelope);

}  // namespace armature::report::joints
