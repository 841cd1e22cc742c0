// SPDX-License-Identifier: Apache-2.0
// Writes the detector that dlib ships into a header, unpacked: unpack FILE. dlib itself unpacks it
// anew in every program.
#include <dlib/image_processing/frontal_face_detector.h>

#include <fstream>
#include <iostream>

namespace {

constexpr std::size_t kBytesInALine = 32;

/// A byte of a text literal, always as three octal digits: a digit after it is not taken for a part
/// of it.
void write_byte(std::ostream& out, unsigned char byte) {
  out << '\\' << (byte >> 6) << ((byte >> 3) & 7) << (byte & 7);
}

void write_header(std::ostream& out, const std::string& bytes) {
  out << "// Written by unpack.cpp.\n#pragma once\n\n#include <string_view>\n\n"
         "namespace armature::detector::hog {\n\n"
         "/// dlib's frontal face detector as dlib serialises it.\n"
         "inline constexpr std::string_view kTrainedDetector{\n";
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    if (i % kBytesInALine == 0) out << (i == 0 ? "    \"" : "\"\n    \"");
    write_byte(out, static_cast<unsigned char>(bytes[i]));
  }
  out << "\", " << bytes.size() << "};\n\n}  // namespace armature::detector::hog\n";
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: unpack FILE\n";
    return 2;
  }
  std::ofstream out{argv[1]};
  write_header(out, dlib::get_serialized_frontal_faces());
  out.close();
  if (out) return 0;
  std::cerr << "unpack: cannot write " << argv[1] << "\n";
  return 1;
}
