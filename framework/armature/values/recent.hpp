// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <utility>

namespace armature {

/// What is known by keys that come and go for ever, in bounded memory: what was not asked for
/// lately is forgotten. Of two halves the younger one takes what is new or asked for; when it is
/// full it becomes the older one, and what was left there is gone. Not real-time safe.
template <class Key, class Value, class Less = std::less<>>
class Recent {
 public:
  /// At least half of `most` keys are kept, and no more than `most`.
  explicit Recent(std::size_t most = 1024) : half_{most / 2} {}

  /// Valid until the next call; nullptr: it is not known, or not any more.
  Value* find(const Key& key) {
    if (const auto young = young_.find(key); young != young_.end()) return &young->second;
    auto node = old_.extract(key);
    if (node.empty()) return nullptr;
    make_room();
    return &young_.insert(std::move(node)).position->second;
  }
  /// Valid until the next call. Replaces what is known of `key`.
  Value& put(const Key& key, Value value) {
    if (Value* known = find(key)) return *known = std::move(value);
    make_room();
    return young_.emplace(key, std::move(value)).first->second;
  }
  std::size_t size() const { return young_.size() + old_.size(); }

 private:
  void make_room() {
    if (young_.size() >= half_) old_ = std::exchange(young_, {});
  }

  std::size_t half_;
  std::map<Key, Value, Less> young_, old_;
};

}  // namespace armature
