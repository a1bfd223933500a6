#include "gpu/program_files.h"

#include <gmock/gmock.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <string>
#include <thread>
#include <vector>

#include "support/temporary_directory.h"

namespace aspic::gl {
namespace {

namespace fs = std::filesystem;

const std::string key = "0123456789abcdef0123456789abcdef", other_key = "fedcba9876543210fedcba9876543210";

ProgramBinary binary_of(std::size_t bytes, char fill) {
  return {0x1234, std::string(bytes, fill)};
}

std::string file_of(const std::string& name) {
  return name + ".program";
}

mode_t mode_of(const fs::path& path) {
  struct stat found = {};
  EXPECT_EQ(::stat(path.c_str(), &found), 0) << path;
  return found.st_mode & 07777;
}

class ProgramFilesTest : public ::testing::Test {
 protected:
  test::TemporaryDirectory directory_;
  const fs::path folder_ = directory_.path() / "aspic/programs";
};

TEST_F(ProgramFilesTest, ReturnsWhatAnEarlierProcessStored) {
  EXPECT_FALSE(ProgramFiles(folder_).load(key));
  ProgramFiles(folder_).store(key, binary_of(1000, 'a'));
  ProgramFiles(folder_).store(other_key, binary_of(10, 'b'));
  const auto found = ProgramFiles(folder_).load(key);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->format, 0x1234u);
  EXPECT_EQ(found->bytes, std::string(1000, 'a'));
  ProgramFiles(folder_).store(key, binary_of(20, 'c'));
  EXPECT_EQ(ProgramFiles(folder_).load(key)->bytes, std::string(20, 'c'));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 2);
}

TEST_F(ProgramFilesTest, GivesFilesAndFoldersToTheUserAlone) {
  ProgramFiles(folder_).store(key, binary_of(10, 'a'));
  EXPECT_EQ(mode_of(folder_), 0700u);
  EXPECT_EQ(mode_of(folder_.parent_path()), 0700u);
  EXPECT_EQ(mode_of(folder_ / file_of(key)), 0600u);
}

TEST_F(ProgramFilesTest, IgnoresDamagedFiles) {
  ProgramFiles files(folder_);
  files.store(key, binary_of(40, 'a'));
  const std::string name = "aspic/programs/" + file_of(key), whole = directory_.read(name);
  for (std::size_t at = 0; at < whole.size(); ++at) {
    std::string damaged = whole;
    damaged[at] = static_cast<char>(damaged[at] ^ 0x10);
    directory_.write(name, damaged);
    EXPECT_FALSE(files.load(key)) << "byte " << at;
    directory_.write(name, whole.substr(0, at));
    EXPECT_FALSE(files.load(key)) << "cut to " << at;
  }
  directory_.write(name, whole + "a");
  EXPECT_FALSE(files.load(key));
  directory_.write(name, whole);
  EXPECT_TRUE(files.load(key));
}

TEST_F(ProgramFilesTest, IgnoresFilesThatAreNotItsOwn) {
  ProgramFiles files(folder_);
  files.store(key, binary_of(40, 'a'));
  fs::copy_file(folder_ / file_of(key), folder_ / file_of(other_key));
  EXPECT_FALSE(files.load(other_key)) << "a file of another key";
  fs::permissions(folder_ / file_of(key), fs::perms::others_write, fs::perm_options::add);
  EXPECT_FALSE(files.load(key)) << "others may write it";
  fs::remove(folder_ / file_of(key));
  fs::create_directory(folder_ / file_of(key));
  EXPECT_FALSE(files.load(key)) << "a folder";
  fs::remove(folder_ / file_of(key));
  ASSERT_EQ(::mkfifo((folder_ / file_of(key)).c_str(), 0600), 0);
  EXPECT_FALSE(files.load(key)) << "a pipe";
}

TEST_F(ProgramFilesTest, KeepsNothingWhereNothingCanBeWritten) {
  directory_.write("file", "");
  for (const fs::path& folder : {fs::path(), directory_.path() / "file/below", fs::path("/proc/aspic")}) {
    ProgramFiles files(folder);
    files.store(key, binary_of(10, 'a'));
    EXPECT_FALSE(files.load(key)) << folder;
    EXPECT_EQ(files.bytes(), 0u);
  }
}

TEST_F(ProgramFilesTest, LeavesNothingOfAFileThatIsTooLargeForTheDisk) {
  ProgramFiles files(folder_);
  files.store(other_key, binary_of(10, 'a'));
  rlimit old = {};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &old), 0);
  const rlimit small = {100, old.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  files.store(key, binary_of(1000, 'a'));
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &old), 0);
  EXPECT_FALSE(files.load(key));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1);
}

TEST_F(ProgramFilesTest, RemovesTheLeastRecentlyUsedBeyondItsBound) {
  constexpr std::uint64_t most = 10000;
  ProgramFiles files(folder_, most);
  const auto name = [](int i) { return "k" + std::to_string(i); };
  const auto now = fs::file_time_type::clock::now();
  const auto store = [&](int i) {
    files.store(name(i), binary_of(1000, 'a'));
    fs::last_write_time(folder_ / file_of(name(i)), now - std::chrono::hours(100 - i));
  };
  for (int i = 0; i < 9; ++i) store(i);
  // A process that was killed as it wrote left this.
  fs::copy_file(folder_ / file_of(name(8)), folder_ / ".1-0.program");
  fs::last_write_time(folder_ / ".1-0.program", now - std::chrono::hours(200));
  EXPECT_TRUE(files.load(name(0)));  // that is use
  for (int i = 9; i < 12; ++i) store(i);
  EXPECT_LE(files.bytes(), most);
  EXPECT_TRUE(files.load(name(0)));
  EXPECT_TRUE(files.load(name(11)));
  EXPECT_FALSE(files.load(name(1)));
  EXPECT_FALSE(fs::exists(folder_ / ".1-0.program"));
  files.store("large", binary_of(most, 'a'));
  EXPECT_FALSE(files.load("large"));
  EXPECT_TRUE(files.load(name(11)));
}

TEST_F(ProgramFilesTest, IsSharedByWritersAndReadersAtOnce) {
  std::vector<std::thread> threads;
  for (const char fill : {'a', 'b', 'c'}) {
    threads.emplace_back([this, fill] {
      ProgramFiles files(folder_, 6000);
      for (int i = 0; i < 100; ++i) {
        files.store("k" + std::to_string(i % 5), binary_of(1000, fill));
        const auto found = files.load("k" + std::to_string((i + 1) % 5));
        EXPECT_TRUE(!found || found->bytes == std::string(1000, found->bytes.front()));
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (const auto& entry : fs::directory_iterator(folder_))
    EXPECT_NE(entry.path().filename().string().front(), '.') << entry.path();
}

TEST(ProgramFolder, FollowsTheEnvironment) {
  const auto kept = [](const char* name) {
    const char* const value = std::getenv(name);
    return std::pair{std::string(name), value ? std::optional<std::string>(value) : std::nullopt};
  };
  const std::vector before = {kept("ASPIC_SHADER_CACHE"), kept("XDG_CACHE_HOME"), kept("HOME")};
  const auto folder = [](const char* own, const char* cache, const char* home) {
    ::setenv("ASPIC_SHADER_CACHE", own, 1);
    ::setenv("XDG_CACHE_HOME", cache, 1);
    ::setenv("HOME", home, 1);
    return program_folder();
  };
  EXPECT_EQ(folder("", "/c", "/h"), "/c/aspic/programs");
  EXPECT_EQ(folder("", "", "/h"), "/h/.cache/aspic/programs");
  EXPECT_EQ(folder("", "relative/paths/do/not/count", "/h"), "/h/.cache/aspic/programs");
  EXPECT_EQ(folder("", "", ""), "");
  EXPECT_EQ(folder("off", "/c", "/h"), "");
  EXPECT_EQ(folder("/mine", "/c", "/h"), "/mine");
  for (const auto& [name, value] : before)
    value ? ::setenv(name.c_str(), value->c_str(), 1) : ::unsetenv(name.c_str());
}

}  // namespace
}  // namespace aspic::gl
