#include "cli/process.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cctype>
#include <fstream>
#include <regex>
#include <sstream>
#include <string_view>

namespace aspic::test {
namespace {

/// Checks one JSON value after another without building anything.
class JsonScanner {
 public:
  explicit JsonScanner(std::string_view text) : text_(text) {}

  bool whole() {
    const bool good = value();
    space();
    return good && at_ == text_.size();
  }

 private:
  void space() {
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_]))) ++at_;
  }
  bool take(std::string_view token) {
    if (text_.substr(at_, token.size()) != token) return false;
    at_ += token.size();
    return true;
  }
  bool string() {
    if (!take("\"")) return false;
    while (at_ < text_.size() && text_[at_] != '"') {
      if (static_cast<unsigned char>(text_[at_]) < 0x20) return false;
      at_ += text_[at_] == '\\' ? 2 : 1;
    }
    return take("\"");
  }
  bool number() {
    static const std::regex pattern(R"(-?(0|[1-9]\d*)(\.\d+)?([eE][-+]?\d+)?)");
    std::match_results<std::string_view::const_iterator> match;
    if (!std::regex_search(text_.begin() + static_cast<std::ptrdiff_t>(at_), text_.end(), match, pattern,
                           std::regex_constants::match_continuous)) {
      return false;
    }
    at_ += static_cast<std::size_t>(match.length());
    return true;
  }
  bool list(std::string_view end, bool keys) {
    space();
    if (take(end)) return true;
    do {
      space();
      if (keys) {
        if (!string()) return false;
        space();
        if (!take(":")) return false;
      }
      if (!value()) return false;
      space();
    } while (take(","));
    return take(end);
  }
  bool value() {
    space();
    if (take("{")) return list("}", true);
    if (take("[")) return list("]", false);
    if (take("true") || take("false") || take("null")) return true;
    return at_ < text_.size() && text_[at_] == '"' ? string() : number();
  }

  std::string_view text_;
  std::size_t at_ = 0;
};

}  // namespace

Process::Process(const std::vector<std::string>& arguments, const ProcessOptions& options) {
  const std::string out = options.stdout_file.empty() ? captured_.file("out") : options.stdout_file;
  const std::string err = captured_.file("err");
  std::vector<std::string> words = {options.program.empty() ? ASPIC_PROGRAM : options.program};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  pid_ = ::fork();
  if (pid_ != 0) return;
  for (const auto& [name, value] : options.environment) ::setenv(name.c_str(), value.c_str(), 1);
  ::dup2(::open("/dev/null", O_RDONLY), 0);
  ::dup2(::open(out.c_str(), O_WRONLY | O_CREAT, 0600), 1);
  ::dup2(::open(err.c_str(), O_WRONLY | O_CREAT, 0600), 2);
  if (options.file_size_limit) {
    const rlimit limit = {*options.file_size_limit, *options.file_size_limit};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  if (options.stdout_to_closed_pipe) {
    int ends[2];
    if (::pipe(ends) != 0) ::_exit(127);
    ::dup2(ends[1], 1);
    ::close(ends[0]);
    ::close(ends[1]);
  }
  for (const int descriptor : options.closed) ::close(descriptor);
  const auto limit = [](int resource, const std::optional<std::uint64_t>& bytes) {
    const rlimit both = {bytes.value_or(0), bytes.value_or(0)};
    if (bytes) ::setrlimit(static_cast<__rlimit_resource_t>(resource), &both);
  };
  limit(RLIMIT_AS, options.address_space_limit);
  limit(RLIMIT_STACK, options.stack_limit);
  ::alarm(120);  // outlives exec: a program that hangs ends by SIGALRM and fails its test
  ::execv(argv[0], argv.data());
  ::_exit(127);
}

Process::~Process() {
  if (pid_ <= 0) return;
  ::kill(pid_, SIGKILL);
  ::waitpid(pid_, nullptr, 0);
}

void Process::send(int signal) const {
  ::kill(pid_, signal);
}

bool Process::catches(int signal) const {
  std::ifstream status("/proc/" + std::to_string(pid_) + "/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with("SigCgt:"))
      return (std::stoull(line.substr(7), nullptr, 16) >> (signal - 1) & 1) != 0;
  }
  return true;  // it has ended
}

Finished Process::wait() {
  int status = 0;
  ::waitpid(pid_, &status, 0);
  pid_ = -1;
  Finished finished;
  if (WIFEXITED(status)) finished.exit_code = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) finished.signal = WTERMSIG(status);
  finished.out = captured_.read("out");
  finished.err = captured_.read("err");
  return finished;
}

Finished aspic(const std::vector<std::string>& arguments, const ProcessOptions& options) {
  return Process(arguments, options).wait();
}

bool is_json(const std::string& text) {
  return JsonScanner(text).whole();
}

std::string json_member(const std::string& text, const std::string& name) {
  const std::string key = "\"" + name + "\": ";
  const std::size_t at = text.find(key);
  if (at == std::string::npos) return "";
  std::string value = text.substr(at + key.size(), text.find_first_of(",\n", at) - at - key.size());
  if (value.size() >= 2 && value.front() == '"') value = value.substr(1, value.size() - 2);
  return value;
}

std::vector<std::string> lines(const std::string& text) {
  std::vector<std::string> result;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) result.push_back(line);
  return result;
}

}  // namespace aspic::test
