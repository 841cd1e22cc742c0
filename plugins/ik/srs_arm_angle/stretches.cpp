// SPDX-License-Identifier: Apache-2.0
#include "stretches.hpp"

#include <numbers>

#include "places.hpp"

namespace armature {

void Stretches::add(std::size_t branch, const Spans& spans) {
  const Span *first = spans.begin(), *end = spans.end();
  if (first == end) return;
  const bool round = first->lower == -std::numbers::pi && (end - 1)->upper == std::numbers::pi;
  if (round && end - first > 1 && first->upper == first->lower) {
    ++first;  // pi stands for it
  } else if (round && end - first > 1 && (end - 1)->upper == (end - 1)->lower) {
    --end;  // -pi stands for it
  } else if (round) {
    add_across_cut(branch, *--end, *first++);
  }
  for (; first < end; ++first) add_stretch(branch, *first);
}

/// Of a span that is cut at pi, the parts before and behind; one and the same all round.
void Stretches::add_across_cut(std::size_t branch, const Span& before, const Span& behind) {
  constexpr double kTurn = 2 * std::numbers::pi;
  const Span from_below{before.lower, behind.upper + kTurn},
      from_above{before.lower - kTurn, behind.upper};
  if (&before == &behind) return put({from_below, branch, 0, table_.sorted, true, true});
  const int first = place_from(table_, before.lower), end = place_from(table_, behind.upper);
  if (end + table_.sorted - 1 - first < kFew) return add_narrow(branch, from_below);
  put({from_above, branch, 0, end, true, false});
  put({from_below, branch, first, table_.sorted, false, true});
}

void Stretches::add_stretch(std::size_t branch, const Span& span) {
  int first = place_from(table_, span.lower);
  const int end = place_from(table_, span.upper);
  // A place at an end is left to that end's double precision.
  first += table_.place[first] == span.lower ? 1 : 0;
  if (end - first < kFew) return add_narrow(branch, span);
  put({span, branch, first, end, false, false});
}

static_assert(Stretches::kMax * Stretches::kInner <= CostTable::kMaxNarrow);
void Stretches::add_narrow(std::size_t branch, const Span& span) {
  const int first = table_.count;
  const double width = span.upper - span.lower;
  for (int i = 1; i <= kInner && width > kTiny; ++i) {
    table_.place[table_.count++] = span.lower + width * i / (kInner + 1);
  }
  put({span, branch, first, table_.count, false, false});
}

}  // namespace armature
