// SPDX-License-Identifier: Apache-2.0
// The sources of Armature as a folder of another project, without DDS, OpenCV and dlib.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "armature/values/temporary_folder.hpp"
#include "command.hpp"
#include "page.hpp"
#include "tests/text.hpp"

namespace armature::test {
namespace {

TEST(Embedded, TheLibraryIsAPartOfAnothersBuild) {
  const TemporaryFolder folder;
  const std::string page = text_of(source_file("docs/library.md"));
  std::ofstream{folder / "CMakeLists.txt"} << block_of(page, "txt");
  std::ofstream{folder / "reach.cpp"} << block_of(page, "cpp");
  std::filesystem::create_directory_symlink(ARMATURE_SOURCE_DIR, folder / "armature");
  const auto shell = [&](const std::string& script) {
    return run_command({"/bin/bash", "-c", "set -e\ncd " + folder.path().string() + "\n" + script},
                       {}, std::chrono::seconds{280});
  };
  // A package that is not disabled here and missing would be told as an error of CMake.
  const auto configured =
      shell(CMAKE_PROGRAM
            " -S . -B build -G Ninja -DCMAKE_CXX_STANDARD=20"
            " -DCMAKE_DISABLE_FIND_PACKAGE_fastrtps=ON -DCMAKE_DISABLE_FIND_PACKAGE_fastcdr=ON"
            " -DCMAKE_DISABLE_FIND_PACKAGE_OpenSSL=ON");
  ASSERT_EQ(configured.exit_code, 0) << configured.err;
  EXPECT_NE(configured.out.find("task/biopsy is left out: there is no Armature::kinds here"),
            std::string::npos)
      << configured.out;
  const auto built = shell("cmake --build build --target reach ik_numeric");
  ASSERT_EQ(built.exit_code, 0) << built.out;
  const auto result = shell("build/reach armature/configs/robots/dental_lamp.yaml");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(result.out.starts_with("ok\n")) << result.out;
}

}  // namespace
}  // namespace armature::test
