// SPDX-License-Identifier: Apache-2.0
#include "inspect/graph_drawing.hpp"

#include <gtest/gtest.h>

namespace armature {
namespace {

DrawnGraph graph() {
  return {
      .deployment = "lamp",
      .components = {{"camera", "sim/photo", "vision"}, {"motion.planner", "motion/goal", "main"}},
      .topics = {
          {"/lamp/image", {"sensor_msgs/Image", {"camera"}, {{"motion.planner", false}}}},
          {"/lamp/state", {"sensor_msgs/JointState", {"motion.planner"}, {{"camera", true}}}}}};
}

TEST(GraphDrawing, IsATableForPeople) {
  EXPECT_EQ(drawing_of(graph(), GraphFormat::text),
            "/lamp/image  sensor_msgs/Image                camera -> motion.planner\n"
            "/lamp/state  sensor_msgs/JointState           motion.planner -> camera\n");
}

TEST(GraphDrawing, FramesTheProcessesForGraphvizAndDashesFeedback) {
  EXPECT_EQ(drawing_of(graph(), GraphFormat::dot),
            "digraph \"lamp\" {\n  rankdir=LR;\n  node [shape=box];\n"
            "  subgraph \"cluster_main\" {\n    label=\"process main\";\n"
            "    \"motion.planner\" [label=\"motion.planner\\nmotion/goal\"];\n  }\n"
            "  subgraph \"cluster_vision\" {\n    label=\"process vision\";\n"
            "    \"camera\" [label=\"camera\\nsim/photo\"];\n  }\n"
            "  \"camera\" -> \"motion.planner\" [label=\"/lamp/image\"];\n"
            "  \"motion.planner\" -> \"camera\" [label=\"/lamp/state\", style=dashed];\n}\n");
}

TEST(GraphDrawing, IsAFlowchartForMermaid) {
  EXPECT_EQ(drawing_of(graph(), GraphFormat::mermaid),
            "flowchart LR\n"
            "  subgraph p_main[\"process main\"]\n    "
            "c_motion_planner[\"motion.planner<br>motion/goal\"]\n  end\n"
            "  subgraph p_vision[\"process vision\"]\n    c_camera[\"camera<br>sim/photo\"]\n"
            "  end\n"
            "  c_camera -->|\"/lamp/image\"| c_motion_planner\n"
            "  c_motion_planner -.->|\"/lamp/state\"| c_camera\n");
}

TEST(GraphDrawing, HasNoFrameAroundTheOnlyProcess) {
  DrawnGraph one = graph();
  for (auto& component : one.components) component.process = "main";
  EXPECT_EQ(drawing_of(one, GraphFormat::mermaid).find("subgraph"), std::string::npos);
  EXPECT_EQ(drawing_of(one, GraphFormat::dot).find("subgraph"), std::string::npos);
}

}  // namespace
}  // namespace armature
