// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "armature/values/expected.hpp"
#include "armature/values/time.hpp"
#include "gray_picture.hpp"

namespace armature::pictures {

enum class Side { left, right };

/// One picture and its times, both by the clock of the source.
struct TimedPicture {
  Side side = Side::left;
  Time stamp;      // when it was taken
  Time published;  // when it came
  Expected<GrayPicture> picture;
};

/// Pictures of two cameras in the order in which they came. One thread at a time; it reads files.
class PictureSource {
 public:
  virtual ~PictureSource() = default;
  /// The next one, usable or with the reason why it is not; nothing after the last one, or when
  /// much was looked through without one.
  virtual std::optional<TimedPicture> next() = 0;
  /// After nothing came: whether something may come still.
  virtual bool has_more() const { return false; }
  /// Begins again with the first one.
  virtual void rewind() = 0;
  /// How long the last picture lasts until the first one may come again.
  virtual Duration last_interval() const = 0;
  /// What was left out of the source, or is wrong with it, for people; empty: nothing.
  virtual std::string remark() const = 0;
  /// How many pictures were left out.
  virtual std::size_t left_out() const { return 0; }
};

}  // namespace armature::pictures
