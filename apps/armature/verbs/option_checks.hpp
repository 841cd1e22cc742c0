// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace armature {

// What is wrong with the text of an option, or "": where the parser of the command line would take
// it for something else.

/// Not a whole number from 0 to 2^64 - 1: -1 would be the largest one.
std::string wrong_seed(const std::string& text);
/// Not a finite number: NaN is within any range.
std::string wrong_number(const std::string& text);
/// Not a finite number above 0.
std::string not_positive(const std::string& text);
/// No interface of this machine that DDS can join, by name or IPv4 address.
std::string no_interface(const std::string& text);
/// No name of a host and no IPv4 address; whether there is such a host is not asked.
std::string no_host(const std::string& text);
/// A "*" that is not at its end.
std::string no_pattern(const std::string& text);
/// "-", which means standard output elsewhere: a recording is written with its end in mind, into a
/// file.
std::string no_file(const std::string& text);
/// Empty, as a variable of the shell is that nobody set.
std::string no_name(const std::string& text);
/// Longer than what a client of the web server can say.
std::string no_token(const std::string& text);
/// No beginning of a ROS 2 topic's name.
std::string no_prefix(const std::string& text);
/// Bytes that are no UTF-8: what is sent on topics is text.
std::string no_text(const std::string& text);
/// Not the 64 hexadecimal digits of a SHA-256, in small letters.
std::string no_hash(const std::string& text);
/// The same text with a to f for A to F, as a hash is written by either.
std::string in_small_letters(std::string text);
/// No "host" or "host:port" of a discovery server.
std::string no_server(const std::string& text);

}  // namespace armature
