// SPDX-License-Identifier: Apache-2.0
#include "completion/script.hpp"

#include <fmt/format.h>

#include <string_view>

#include "exit_code.hpp"
#include "standard_output.hpp"

namespace armature {
namespace {

// tools/armature of a source tree builds first: whoever presses Tab asks what is built already.

// bash breaks words at '=', after which --set goes on.
constexpr std::string_view kBash = R"sh(# bash completion of armature
_armature() {
  local program="${1/#\~/$HOME}" words=() glue=0 word line cut
  program="${program/%tools\/armature/build/release/bin/armature}"
  for word in "${COMP_WORDS[@]:1:COMP_CWORD}"; do
    if ((${#words[@]} > 0)) && { [[ $word == "=" ]] || ((glue)); }; then
      words[-1]+=$word
    else
      words+=("$word")
    fi
    [[ $word == "=" ]] && glue=1 || glue=0
  done
  cut="${words[-1]}"
  [[ $cut == *=* && $COMP_WORDBREAKS == *=* ]] && cut="${cut%=*}=" || cut=
  COMPREPLY=()
  while IFS= read -r line; do
    line="${line%%$'\t'*}"
    COMPREPLY+=("${line#"$cut"}")
    [[ $line == *[/.=] ]] && compopt -o nospace 2> /dev/null
  done < <("$program" __complete "${words[@]}" 2> /dev/null)
}
complete -o default -F _armature armature
)sh";

constexpr std::string_view kZsh = R"sh(#compdef armature
# zsh completion of armature
_armature() {
  local program="${${(Q)words[1]}/#\~/$HOME}" line
  local -a whole open
  program="${program/%tools\/armature/build/release/bin/armature}"
  for line in "${(@f)$("$program" __complete "${(@Q)words[2,CURRENT]}" 2> /dev/null)}"; do
    line="${line%%$'\t'*}"
    case "$line" in
      '') ;;
      *[/.=]) open+=("$line") ;;
      *) whole+=("$line") ;;
    esac
  done
  (( ${#whole} + ${#open} )) || { _files; return; }
  (( ${#whole} )) && compadd -- "${whole[@]}"
  (( ${#open} )) && compadd -S '' -- "${open[@]}"
  return 0
}
if [[ "${funcstack[1]}" == _armature ]]; then _armature "$@"; else compdef _armature armature; fi
)sh";

constexpr std::string_view kFish = R"sh(# fish completion of armature
function __armature_candidates
    set -l words (commandline -opc) (commandline -ct)
    set -l program (string replace -r 'tools/armature$' build/release/bin/armature -- $words[1])
    $program __complete $words[2..-1] 2> /dev/null
end
complete -c armature -f -a '(__armature_candidates)'
complete -c armature -n 'test -z "$(__armature_candidates)"' -F
)sh";

/// The completion of bash, zsh or fish.
std::string_view script_of(const std::string& shell) {
  if (shell == "bash") return kBash;
  if (shell == "zsh") return kZsh;
  return kFish;
}

}  // namespace

int print_completion(const std::string& shell) {
  print_out("{}", script_of(shell));
  return kOk;
}

}  // namespace armature
