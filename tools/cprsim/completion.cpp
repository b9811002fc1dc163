// SPDX-License-Identifier: BSD-3-Clause
// cprsim completion: scripts that complete words in a shell. They ask the program itself what there
// is, so that they never fall behind it.
#include <string>

#include "tools/cprsim/commands.h"

namespace cprsim {

namespace {

constexpr const char* kBash =
    R"sh(# cprsim completion bash > ~/.local/share/bash-completion/completions/cprsim
_cprsim() {
  local word=${COMP_WORDS[COMP_CWORD]} command=run first=${COMP_WORDS[1]}
  local commands
  commands=$(cprsim completion commands)
  case " $commands " in *" $first "*) command=$first ;; esac
  if [[ $word == -* ]]; then
    COMPREPLY=($(compgen -W "$(cprsim completion options "$command")" -- "$word"))
  else
    COMPREPLY=($(compgen -f -- "$word"))
    if ((COMP_CWORD == 1)); then COMPREPLY+=($(compgen -W "$commands" -- "$word")); fi
  fi
}
complete -o filenames -F _cprsim cprsim
)sh";

constexpr const char* kZsh = R"sh(#compdef cprsim
# cprsim completion zsh > a file called _cprsim in a folder of $fpath
local command=run
local -a commands
commands=(${=$(cprsim completion commands)})
if (( ${commands[(Ie)${words[2]}]} )); then command=${words[2]}; fi
if [[ ${words[CURRENT]} == -* ]]; then
  compadd -- ${=$(cprsim completion options $command)}
else
  if (( CURRENT == 2 )); then compadd -- $commands; fi
  _files
fi
)sh";

constexpr const char* kFish =
    R"sh(# cprsim completion fish > ~/.config/fish/completions/cprsim.fish
function __cprsim_options
  set -l words (commandline -opc)
  set -l command run
  if test (count $words) -gt 1; and contains -- $words[2] (string split ' ' (cprsim completion commands))
    set command $words[2]
  end
  string split ' ' (cprsim completion options $command)
end
complete -c cprsim -n __fish_use_subcommand -a "(string split ' ' (cprsim completion commands))"
complete -c cprsim -n 'string match -q -- "-*" (commandline -ct)' -a "(__cprsim_options)"
)sh";

}  // namespace

std::string shell_script(const std::string& shell) {
  return shell == "bash" ? kBash : shell == "zsh" ? kZsh : shell == "fish" ? kFish : "";
}

}  // namespace cprsim
