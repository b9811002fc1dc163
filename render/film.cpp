// SPDX-License-Identifier: BSD-3-Clause
#include "render/film.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "render/yuv.h"

extern char** environ;

namespace cprsim {

namespace {

const char* const kNeedsFfmpeg = "films need the ffmpeg program: install the Debian package ffmpeg";

std::string find_program(const std::string& name) {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path ? path : "/usr/local/bin:/usr/bin:/bin");
  for (std::string folder; std::getline(folders, folder, ':');) {
    const std::string file = (folder.empty() ? "." : folder) + "/" + name;
    if (access(file.c_str(), X_OK) == 0) return file;
  }
  return "";
}

/// A broken pipe is to be an error of write(), not the end of the program.
void ignore_broken_pipes() {
  struct sigaction now {};

  if (sigaction(SIGPIPE, nullptr, &now) == 0 && now.sa_handler == SIG_DFL) {
    std::signal(SIGPIPE, SIG_IGN);
  }
}

/// Two encoder threads, always: with another number the file's bytes would differ.
std::vector<std::string> arguments(int width, int height, double fps, const std::string& file) {
  std::array<char, 40> rate{}, size{};
  std::snprintf(rate.data(), rate.size(), "%.10g", fps);
  std::snprintf(size.data(), size.size(), "%dx%d", width, height);
  const std::vector<std::string> color{"-color_range",     "tv",    "-colorspace", "bt709",
                                       "-color_primaries", "bt709", "-color_trc",  "bt709"};
  std::vector<std::string> all{"ffmpeg",      "-nostdin",  "-hide_banner", "-loglevel", "error",
                               "-y",          "-f",        "rawvideo",     "-pix_fmt",  "yuv420p",
                               "-video_size", size.data(), "-framerate",   rate.data()};
  all.insert(all.end(), color.begin(), color.end());
  for (const char* word :
       {"-i",        "pipe:0",   "-an",      "-c:v",          "libx264", "-preset",
        "veryfast",  "-crf",     "17",       "-profile:v",    "high",    "-pix_fmt",
        "yuv420p",   "-threads", "2",        "-map_metadata", "-1",      "-fflags",
        "+bitexact", "-flags:v", "+bitexact"}) {
    all.emplace_back(word);
  }
  all.insert(all.end(), color.begin(), color.end());
  all.insert(all.end(), {"-movflags", "+faststart", "-f", "mp4", "file:" + file});
  return all;
}

/// Starts ffmpeg in a process group of its own, so that Ctrl-C stops the simulation and not the
/// encoder, which then still closes its file.
int start(const std::string& program, std::vector<std::string> words, int input,
          const std::string& log) {
  std::vector<char*> argv;
  for (std::string& word : words)
    argv.push_back(word.data());
  argv.push_back(nullptr);
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_adddup2(&files, input, STDIN_FILENO);
  posix_spawn_file_actions_addopen(&files, STDERR_FILENO, log.c_str(), O_WRONLY | O_CREAT | O_TRUNC,
                                   0644);
  posix_spawn_file_actions_adddup2(&files, STDERR_FILENO, STDOUT_FILENO);
  posix_spawnattr_t how;
  posix_spawnattr_init(&how);
  sigset_t broken_pipe;
  sigemptyset(&broken_pipe);
  sigaddset(&broken_pipe, SIGPIPE);
  posix_spawnattr_setsigdefault(&how, &broken_pipe);
  posix_spawnattr_setpgroup(&how, 0);
  posix_spawnattr_setflags(&how, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGDEF);
  pid_t process = -1;
  const int why = posix_spawn(&process, program.c_str(), &files, &how, argv.data(), environ);
  posix_spawnattr_destroy(&how);
  posix_spawn_file_actions_destroy(&files);
  if (why != 0) throw std::runtime_error(program + ": " + std::strerror(why));
  return process;
}

/// The program's exit status; 128 + n if signal n ended it.
int wait_for(int process) {
  int status = 0;
  while (waitpid(process, &status, 0) < 0) {
    if (errno != EINTR) return -1;
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace

std::string film_unavailable() {
  return find_program("ffmpeg").empty() ? kNeedsFfmpeg : "";
}

Film::Film() = default;

Film::~Film() {
  abandon();
}

void Film::open(const std::string& path, int width, int height, double fps) {
  abandon();
  const std::string program = find_program("ffmpeg");
  if (program.empty()) throw std::runtime_error(path + ": " + kNeedsFfmpeg);
  if (width < 2 || height < 2 || !(fps > 0)) {
    throw std::runtime_error(path + ": a film needs a size of 2 pixels and a positive frame rate");
  }
  path_ = path;
  part_ = path + ".part.mp4";
  log_ = path + ".part.log";
  width_ = width - width % 2;
  height_ = height - height % 2;
  frames_ = 0;
  // fail now rather than after the run if the place cannot be written
  std::FILE* probe = std::fopen(part_.c_str(), "wb");
  if (probe == nullptr)
    throw std::runtime_error(path + ": cannot be written: " + std::strerror(errno));
  std::fclose(probe);
  ignore_broken_pipes();
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) throw std::runtime_error(path + ": no pipe to ffmpeg");
  // a larger pipe lets a frame be handed over while the encoder is busy; it is only a wish
  fcntl(ends[1], F_SETPIPE_SZ, 1 << 20);
  pipe_ = ends[1];
  try {
    process_ = start(program, arguments(width_, height_, fps, part_), ends[0], log_);
  } catch (...) {
    ::close(ends[0]);
    abandon();
    throw;
  }
  ::close(ends[0]);
}

void Film::add(const Image& image) {
  if (pipe_ < 0) throw std::runtime_error("no film is open");
  if (image.width < width_ || image.height < height_) {
    throw std::runtime_error(path_ + ": a frame is smaller than the film");
  }
  to_yuv420(image, width_, height_, planes_);
  for (std::size_t done = 0; done < planes_.size();) {
    const ssize_t n = write(pipe_, planes_.data() + done, planes_.size() - done);
    if (n > 0) {
      done += static_cast<std::size_t>(n);
    } else if (errno != EINTR) {
      const std::string reason =
          errno == EPIPE ? "" : std::string(" (") + std::strerror(errno) + ")";
      ::close(pipe_);
      pipe_ = -1;
      wait_for(process_);
      process_ = -1;
      const std::string words = last_words();
      abandon();
      throw std::runtime_error(path_ + ": ffmpeg stopped" + reason + words);
    }
  }
  ++frames_;
}

void Film::close() {
  if (pipe_ < 0) return;
  ::close(pipe_);
  pipe_ = -1;
  const int status = wait_for(process_);
  process_ = -1;
  if (status != 0) {
    const std::string words = last_words();
    abandon();
    throw std::runtime_error(path_ + ": ffmpeg failed with status " + std::to_string(status) +
                             words);
  }
  if (std::rename(part_.c_str(), path_.c_str()) != 0) {
    const std::string reason = std::strerror(errno);
    abandon();
    throw std::runtime_error(path_ + ": cannot be written: " + reason);
  }
  std::remove(log_.c_str());
}

void Film::abandon() {
  if (pipe_ >= 0) ::close(pipe_);
  pipe_ = -1;
  if (process_ > 0) {
    kill(process_, SIGKILL);
    wait_for(process_);
  }
  process_ = -1;
  if (!part_.empty()) std::remove(part_.c_str());
  if (!log_.empty()) std::remove(log_.c_str());
}

std::string Film::last_words() const {
  std::ifstream in(log_);
  std::string all((std::istreambuf_iterator<char>(in)), {});
  while (!all.empty() && (all.back() == '\n' || all.back() == ' '))
    all.pop_back();
  if (all.size() > 600) all = "..." + all.substr(all.size() - 600);
  return all.empty() ? "" : ": " + all;
}

}  // namespace cprsim
