// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/plugins/running_component.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <array>
#include <csignal>

#include "armature/runtime/plugins/running_code.hpp"
#include "armature/values/sanitizer.hpp"

namespace armature {
namespace {

// Read by a signal handler: without the lazy allocation that other thread-local storage may need.
[[gnu::tls_model("initial-exec")]] thread_local const char* t_name = nullptr;
[[gnu::tls_model("initial-exec")]] thread_local const char* t_phase = nullptr;
[[gnu::tls_model("initial-exec")]] thread_local const char* t_what = nullptr;

pid_t g_process = 0;  // a process that a plugin forks is not ours, and its crash not either

constexpr std::array kCrashes{SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT};
constexpr std::size_t kStackSize = 64 * 1024;

/// The name of the signal; strsignal is not safe here.
const char* name_of(int signal) {
  switch (signal) {
    case SIGSEGV: return "SIGSEGV";
    case SIGBUS: return "SIGBUS";
    case SIGFPE: return "SIGFPE";
    case SIGILL: return "SIGILL";
    default: return "SIGABRT";
  }
}

/// One line in one write, cut at the size of its buffer.
class Line {
 public:
  void add(const char* text) {
    while (*text != '\0' && size_ < text_.size()) text_[size_++] = *text++;
  }
  void write_out() const {
    [[maybe_unused]] const auto written = ::write(STDERR_FILENO, text_.data(), size_);
  }

 private:
  std::array<char, 256> text_;
  std::size_t size_ = 0;
};

void on_crash(int signal) {
  if (getpid() != g_process) {
    raise(signal);
    return;
  }
  Line line;
  line.add("armature: ");
  if (const RunningCode running = running_code(); running.name) {
    line.add(running.what);
    line.add(" '");
    line.add(running.name);
    line.add("' crashed in its ");
    line.add(running.phase);
  } else {
    line.add("crashed outside of a component's step");
  }
  line.add(": ");
  line.add(name_of(signal));
  line.add("\n");
  line.write_out();
  raise(signal);  // SA_RESETHAND: what would have happened without this
}

}  // namespace

RunningCode running_code() { return {.what = t_what, .name = t_name, .phase = t_phase}; }

RunningComponent::RunningComponent(const std::string& name, const char* phase, const char* what)
    : outer_name_{t_name}, outer_phase_{t_phase}, outer_what_{t_what} {
  t_what = what;
  t_phase = phase;
  t_name = name.c_str();
}

const char* RunningComponent::name() { return t_name; }

RunningComponent::~RunningComponent() {
  t_name = outer_name_;
  t_phase = outer_phase_;
  t_what = outer_what_;
}

CrashStack::CrashStack()
    : memory_{
          mmap(nullptr, kStackSize, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0)} {
  if (memory_ == MAP_FAILED) return;  // a stack overflow is not told, everything else is
  const stack_t stack{.ss_sp = memory_, .ss_flags = 0, .ss_size = kStackSize};
  sigaltstack(&stack, nullptr);
}

CrashStack::~CrashStack() {
  if (memory_ == MAP_FAILED) return;
  const stack_t none{.ss_sp = nullptr, .ss_flags = SS_DISABLE, .ss_size = 0};
  sigaltstack(&none, nullptr);
  munmap(memory_, kStackSize);
}

void name_crashing_components() {
  if (kSanitized) return;  // it tells more by itself
  g_process = getpid();
  static thread_local const CrashStack stack;
  struct sigaction action {};
  action.sa_handler = on_crash;
  action.sa_flags = static_cast<int>(SA_RESETHAND) | SA_ONSTACK;
  sigemptyset(&action.sa_mask);
  for (const int signal : kCrashes) sigaction(signal, &action, nullptr);
}

}  // namespace armature
