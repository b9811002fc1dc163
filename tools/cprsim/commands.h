// SPDX-License-Identifier: BSD-3-Clause
// The commands, one file each. Every one takes the words after its name and returns an exit code.
#pragma once

#include "tools/cprsim/command_line.h"

namespace cprsim {

int run_command(const Words& words);       ///< simulate; record, film and check as the scene asks
int check_command(const Words& words);     ///< read and validate only
int info_command(const Words& words);      ///< what is in a scene, and what follows from it
int solve_command(const Words& words);     ///< equilibria: pose from drives, drives from pose
int modes_command(const Words& words);     ///< natural frequencies
int identify_command(const Words& words);  ///< values of a scene from measurements
int path_command(const Words& words);      ///< equilibria through folds and branch points
int compare_command(const Words& words);   ///< a run against a reference trajectory
int test_command(const Words& words);      ///< scenes as tests
int sweep_command(const Words& words);     ///< what accuracy costs in time
int effects_command(const Words& words);   ///< what each effect changes and costs
int plot_command(const Words& words);      ///< recordings as pictures
int export_command(const Words& words);    ///< scenes and recordings in other formats
int render_command(const Words& words);    ///< films and pictures of what was recorded
int new_command(const Words& words);       ///< a scene to start from
int explain_command(const Words& words);   ///< the meaning of a code
int doctor_command(const Words& words);    ///< what this machine can do

/// What completes words in bash, zsh or fish; empty for another shell.
std::string shell_script(const std::string& shell);

/// What a robot reaches, of that what is stable and within limits.
int workspace_command(const Words& words);

}  // namespace cprsim
