// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

// What python3 makes of files, for tests.
namespace armature::landmarks::face_mesh {

/// Of a command: what it prints, errors too, and whether it ends with 0.
struct Told {
  std::string text;
  bool succeeded = false;
};

inline Told told_by(const std::string& command) {
  Told told;
  FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  if (!pipe) throw std::runtime_error("cannot run " + command);
  for (int sign = std::fgetc(pipe); sign != EOF; sign = std::fgetc(pipe)) {
    told.text.push_back(static_cast<char>(sign));
  }
  told.succeeded = pclose(pipe) == 0;
  return told;
}

inline std::string source_folder() {
  return std::string{ARMATURE_SOURCE_DIR} + "/plugins/landmarks/face_mesh/";
}

/// A file of this test's own among the temporary ones.
inline std::string temporary(const std::string& name) {
  const auto* test = testing::UnitTest::GetInstance()->current_test_info();
  const std::string own = test ? std::string{test->name()} : "all";
  return testing::TempDir() + "face_mesh_" + std::to_string(getpid()) + "_" +
         own.substr(0, own.find('/')) + "_" + name;
}

inline std::string written(const std::string& name, const std::string& bytes) {
  const std::string file = temporary(name);
  std::ofstream{file, std::ios::binary} << bytes;
  return file;
}

/// What tflite_to_onnx.py says of a file with these bytes, which it is to write as `onnx`.
inline Told converted(const std::string& tflite, const std::string& onnx) {
  const std::string source = written("network.tflite", tflite);
  const Told told =
      told_by("python3 -B " + source_folder() + "tflite_to_onnx.py " + source + " " + onnx);
  std::filesystem::remove(source);
  return told;
}

}  // namespace armature::landmarks::face_mesh
