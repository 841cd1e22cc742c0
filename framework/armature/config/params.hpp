// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "armature/config/key.hpp"
#include "armature/config/node.hpp"
#include "armature/config/problems.hpp"

namespace armature ARMATURE_EXPORT {

/// One parameter as a plugin declares it in its `plugin.yaml`: a key of `params:`, required when it
/// has no fallback. `armature plugin info` tells it.
struct ParamSpec : config::KeySpec {
  std::string same_as;  // a plugin whose parameter of this name says the same; empty: none
  /// "servo_jp.timeout_s": a number that is not above that parameter of any component which reads
  /// this output (0 there is no limit, where `min` keeps the number itself above 0); "poses": one
  /// that is not above that parameter of its own. Empty: any.
  std::string at_most;
  std::string below;  // the parameter of its own that a number is below; empty: any
  std::string
      otherwise;  // what would be wrong if it were not: "noise would be a patient that moves"
};

/// The names of ParamSpec::Type as written in `plugin.yaml`: number, integer, flag, text, choice,
/// numbers, texts, file.
std::string_view to_string(ParamSpec::Type type);

/// Reads a `params:` table of a plugin.yaml; a fallback must itself be a valid value.
std::vector<ParamSpec> read_param_specs(const config::Node& table, config::Problems& problems);

/// Checked parameters of one plugin instance. Asking for a name that is not in the plugin's table,
/// or as another type, is a defect of the plugin and throws std::logic_error naming it.
/// Not real-time safe: read parameters in the constructor.
class Params {
 public:
  Params() = default;
  /// `given` (may be null: nothing given) checked against `specs`: unknown keys with did-you-mean,
  /// wrong types, out of range, missing, above another one. Problems of a missing `given` are noted
  /// at `place`.
  static Params read(const std::vector<ParamSpec>& specs, const config::Node* given,
                     std::string_view plugin_id, config::Problems& problems,
                     const config::Origin& place = {});

  /// In SI units: `_deg` keys arrive in radians, `_mm` keys in metres.
  double number(std::string_view name) const;
  std::vector<double> numbers(std::string_view name) const;
  /// The numbers of a parameter with `count: N`.
  template <std::size_t N>
  std::array<double, N> numbers(std::string_view name) const {
    const std::vector<double> all = numbers(name);
    std::array<double, N> some{};
    std::copy_n(all.begin(), std::min(N, all.size()), some.begin());
    return some;
  }
  std::int64_t integer(std::string_view name) const;
  bool flag(std::string_view name) const;
  /// A text or a choice.
  const std::string& text(std::string_view name) const;
  /// Which one of `choices` it is, from 0 on.
  std::size_t choice(std::string_view name) const;
  const std::vector<std::string>& texts(std::string_view name) const;
  /// A path, resolved against the folder of the YAML file that says it; a fallback and a `--set`
  /// are relative to the current directory. Empty stays empty.
  std::string file(std::string_view name) const;
  /// Where the value came from (the plugin's table for a default).
  const config::Origin& origin(std::string_view name) const;

  /// Whether the user wrote it; else it is a default.
  bool is_written(std::string_view name) const { return find(name).written; }

  /// Takes `name`, unless it was written, from `others`, which have it too. False, and nothing is
  /// taken, when it was written, or taken from elsewhere before, and is not the same there.
  bool agree(std::string_view name, const Params& others);

  /// For values that are right each by itself but not together: throws config::ConfigError with
  /// `message`, at the place of the first of `names` that was written, else of the parameters.
  [[noreturn]] void refuse(std::initializer_list<std::string_view> names,
                           const std::string& message) const;

 private:
  struct Value {
    ParamSpec::Type type;
    config::Value value;
    config::Origin origin;
    bool written = false;
    std::size_t choice = 0;
  };
  void check_order(const ParamSpec& spec, config::Problems& problems) const;
  const Value& find(std::string_view name) const;
  const Value& get(std::string_view name, std::initializer_list<ParamSpec::Type> types) const;

  std::map<std::string, Value, std::less<>> values_;
  std::string plugin_id_;
  config::Origin place_;
};

}  // namespace armature
