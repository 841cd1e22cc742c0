// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "armature/runtime/component/component.hpp"

namespace armature ARMATURE_EXPORT {

/// What a component tells of a run, by key: for tests.
struct Figures final : Summary {
  std::map<std::string, double> metrics;
  std::map<std::string, std::vector<double>> lists;
  std::map<std::string, std::string> texts, unmeasured;
  std::string status, reason;  // of a scenario that failed

  void metric(std::string key, std::string, double value) override { metrics[key] = value; }
  void series(std::string key, std::string, std::vector<double> values) override {
    lists[key] = std::move(values);
  }
  void text(std::string key, std::string, std::string value) override { texts[key] = value; }
  void not_measured(std::string key, std::string, std::string why) override {
    unmeasured[key] = std::move(why);
  }
  void failed(std::string what, std::string why) override {
    status = std::move(what);
    reason = std::move(why);
  }
};

inline Figures figures_of(const Component& component) {
  Figures figures;
  component.summarize(figures);
  return figures;
}

}  // namespace armature
