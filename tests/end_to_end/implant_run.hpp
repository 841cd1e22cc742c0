// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "deployment_run.hpp"
#include "tests/dds_domain.hpp"

namespace armature::test {

/// The bores alone. One run after the other, all in one domain: there are not enough for hundreds.
inline DeploymentRun implant(std::vector<std::string> settings = {}) {
  static const int domain = unique_dds_domain();
  return run_deployment({.files = {source_file("configs/dental_implant.yaml"),
                                   source_file("configs/overlays/drilling_only.yaml")},
                         .settings = std::move(settings),
                         .domain = domain});
}

/// It ends by itself, with the reason; the arm stands still.
inline void expect_refused(const std::vector<std::string>& settings, const std::string& reason) {
  const DeploymentRun run = implant(settings);
  SCOPED_TRACE(run.text());
  EXPECT_EQ(run.command.exit_code, 1);
  EXPECT_EQ(run.status(), "refused");
  EXPECT_NE(run.command.err.find("refused: "), std::string::npos);
  EXPECT_NE(run.word("reason").find(reason), std::string::npos);
  EXPECT_NE(run.command.err.find(reason), std::string::npos);
  EXPECT_FALSE(run.tells("site_error_mm"));
  EXPECT_LE(run.figure("final_speed_rad_s"), 1e-9);
}

}  // namespace armature::test
