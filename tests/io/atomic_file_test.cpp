#include "io/atomic_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <thread>

#include "base/end_request.h"
#include "base/files.h"
#include "io/program.h"
#include "support/temporary_directory.h"

namespace aspic {
namespace {

using testing::HasSubstr;

TEST(AtomicFile, AppearsWholeOnCommit) {
  const test::TemporaryDirectory dir;
  auto file = AtomicFile::create(dir.file("a.txt"), Overwrite::refuse);
  ASSERT_TRUE(file.ok());
  ASSERT_TRUE(file->write("one\n").ok());
  EXPECT_FALSE(std::filesystem::exists(dir.file("a.txt")));
  ASSERT_TRUE(file->write(std::string(1 << 20, 'x')).ok());
  ASSERT_TRUE(file->commit().ok());
  EXPECT_EQ(dir.read("a.txt"), "one\n" + std::string(1 << 20, 'x'));
  EXPECT_EQ(dir.entries(), 1u);
}

TEST(AtomicFile, LeavesNothingWithoutCommit) {
  const test::TemporaryDirectory dir;
  {
    auto file = AtomicFile::create(dir.file("a.txt"), Overwrite::refuse);
    ASSERT_TRUE(file.ok());
    ASSERT_TRUE(file->write(std::string(1 << 20, 'x')).ok());
    EXPECT_EQ(dir.entries(), 1u);
  }
  EXPECT_EQ(dir.entries(), 0u);
}

TEST(AtomicFile, RefusesToOverwriteAndLosesNothing) {
  const test::TemporaryDirectory dir;
  dir.write("a.txt", "precious");
  const auto file = AtomicFile::create(dir.file("a.txt"), Overwrite::refuse);
  ASSERT_FALSE(file.ok());
  EXPECT_EQ(file.error().code, ErrorCode::io);
  EXPECT_THAT(file.error().message(), HasSubstr("or pass Overwrite::allow."));
  EXPECT_EQ(dir.read("a.txt"), "precious");
  EXPECT_EQ(dir.entries(), 1u);
}

TEST(AtomicFile, RefusesAFileThatCameInTheMeantime) {
  const test::TemporaryDirectory dir;
  auto file = AtomicFile::create(dir.file("a.txt"), Overwrite::refuse);
  ASSERT_TRUE(file.ok());
  dir.write("a.txt", "somebody else's");
  ASSERT_TRUE(file->write("mine").ok());
  EXPECT_FALSE(file->commit().ok());
  EXPECT_EQ(dir.read("a.txt"), "somebody else's");
  EXPECT_EQ(dir.entries(), 1u);
}

TEST(AtomicFile, OverwritesWhenAllowedAndOnlyOnCommit) {
  const test::TemporaryDirectory dir;
  dir.write("a.txt", "old");
  ASSERT_EQ(::chmod(dir.file("a.txt").c_str(), 0640), 0);
  {
    auto discarded = AtomicFile::create(dir.file("a.txt"), Overwrite::allow);
    ASSERT_TRUE(discarded.ok() && discarded->write("half").ok());
  }
  EXPECT_EQ(dir.read("a.txt"), "old");
  auto file = AtomicFile::create(dir.file("a.txt"), Overwrite::allow);
  ASSERT_TRUE(file.ok() && file->write("new").ok() && file->commit().ok());
  EXPECT_EQ(dir.read("a.txt"), "new");
  struct stat now = {};
  ASSERT_EQ(::stat(dir.file("a.txt").c_str(), &now), 0);
  EXPECT_EQ(now.st_mode & 0777, 0640u);
}

TEST(AtomicFile, FollowsASymbolicLink) {
  const test::TemporaryDirectory dir;
  dir.write("target.txt", "old");
  std::filesystem::create_symlink("target.txt", dir.file("link.txt"));
  auto file = AtomicFile::create(dir.file("link.txt"), Overwrite::allow);
  ASSERT_TRUE(file.ok() && file->write("new").ok() && file->commit().ok());
  EXPECT_TRUE(std::filesystem::is_symlink(dir.file("link.txt")));
  EXPECT_EQ(dir.read("target.txt"), "new");
}

TEST(AtomicFile, WritesThroughLinksToNothing) {
  for (const Overwrite overwrite : {Overwrite::refuse, Overwrite::allow}) {
    const test::TemporaryDirectory dir;
    std::filesystem::create_directory(dir.file("far"));
    std::filesystem::create_symlink("second", dir.file("link.txt"));
    std::filesystem::create_symlink("far/target.txt", dir.file("second"));
    EXPECT_EQ(std::filesystem::weakly_canonical(written_path(dir.file("link.txt"))),
              std::filesystem::weakly_canonical(dir.file("far/target.txt")));
    auto file = AtomicFile::create(dir.file("link.txt"), overwrite);
    ASSERT_TRUE(file.ok()) << file.error().message();
    ASSERT_TRUE(file->write("new").ok());
    const Status committed = file->commit();
    EXPECT_TRUE(committed.ok()) << committed.error().message();
    EXPECT_TRUE(std::filesystem::is_symlink(dir.file("link.txt")));
    EXPECT_EQ(dir.read("far/target.txt"), "new");
    EXPECT_EQ(dir.entries(), 3u);
  }
}

TEST(AtomicFile, RefusesLinksThatLeadNowhere) {
  const test::TemporaryDirectory dir;
  std::filesystem::create_symlink("circle", dir.file("circle"));
  std::filesystem::create_symlink("none/target", dir.file("missing"));
  for (const Overwrite overwrite : {Overwrite::refuse, Overwrite::allow}) {
    EXPECT_FALSE(AtomicFile::create(dir.file("circle"), overwrite).ok());
    const auto missing = AtomicFile::create(dir.file("missing"), overwrite);
    ASSERT_FALSE(missing.ok());
    EXPECT_THAT(missing.error().message(), HasSubstr("none/target through the link"));
  }
  EXPECT_EQ(dir.entries(), 2u);
}

TEST(AtomicFile, AnEndIsNotHeldUpByAPipeWithoutAReader) {
  const test::TemporaryDirectory dir;
  ASSERT_EQ(::mkfifo(dir.file("pipe").c_str(), 0600), 0);
  const InterruptGuard guard;
  std::thread end([] {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    end_requested = true;
  });
  const auto unread = AtomicFile::create(dir.file("pipe"), Overwrite::refuse);
  end.join();
  ASSERT_FALSE(unread.ok());
  EXPECT_EQ(unread.error().code, ErrorCode::interrupted);
  const auto silent = read_file(dir.file("pipe"));
  ASSERT_FALSE(silent.ok());
  EXPECT_EQ(silent.error().code, ErrorCode::interrupted);
}

TEST(AtomicFile, ErrorsSayPathReasonAndRemedy) {
  const test::TemporaryDirectory dir;
  const auto missing = AtomicFile::create(dir.file("none/a.txt"), Overwrite::refuse);
  ASSERT_FALSE(missing.ok());
  EXPECT_THAT(missing.error().message(), HasSubstr(dir.file("none/a.txt")));
  EXPECT_THAT(missing.error().message(), HasSubstr("No such file or directory"));
  EXPECT_THAT(missing.error().message(), HasSubstr("directory exists"));
  const auto directory = AtomicFile::create(dir.path().string(), Overwrite::allow);
  ASSERT_FALSE(directory.ok());
  EXPECT_THAT(directory.error().message(), HasSubstr("not of a directory"));
  EXPECT_FALSE(AtomicFile::create("", Overwrite::refuse).ok());
}

TEST(AtomicFile, FullDeviceIsAnErrorAndTheDeviceStays) {
  auto file = AtomicFile::create("/dev/full", Overwrite::allow);
  ASSERT_TRUE(file.ok());
  ASSERT_TRUE(file->write("x").ok());
  const Status committed = file->commit();
  ASSERT_FALSE(committed.ok());
  EXPECT_EQ(committed.error().code, ErrorCode::io);
  EXPECT_THAT(committed.error().message(), HasSubstr("No space left on device"));
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/full"));
}

TEST(AtomicFile, SizeLimitLeavesNoFile) {
  const test::TemporaryDirectory dir;
  rlimit old = {};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &old), 0);
  const auto before = ::signal(SIGXFSZ, SIG_IGN);  // as run_program() does
  const rlimit small = {1 << 16, old.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  Status written;
  {
    auto file = AtomicFile::create(dir.file("a.txt"), Overwrite::refuse);
    written = file->write(std::string(1 << 20, 'x'));
    EXPECT_FALSE(file->commit().ok());
  }
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &old), 0);
  ::signal(SIGXFSZ, before);
  ASSERT_FALSE(written.ok());
  EXPECT_THAT(written.error().message(), HasSubstr("ulimit -f"));
  EXPECT_EQ(dir.entries(), 0u);
}

TEST(Interrupt, FirstSignalRaisesTheFlagSecondEndsAndCleansUp) {
  const test::TemporaryDirectory dir;
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    const InterruptGuard guard;
    auto file = AtomicFile::create(dir.file("a.txt"), Overwrite::refuse);
    if (!file.ok() || guard.interrupted()) ::_exit(1);
    ::raise(SIGTERM);
    if (!guard.interrupted() || dir.entries() != 1) ::_exit(2);
    ::raise(SIGINT);
    ::_exit(3);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFSIGNALED(status)) << WEXITSTATUS(status);
  EXPECT_EQ(WTERMSIG(status), SIGINT);
  EXPECT_EQ(dir.entries(), 0u);
}

TEST(Interrupt, HangUpsRaiseTheFlagAndNeverEnd) {
  const InterruptGuard guard;
  ::raise(SIGHUP);
  EXPECT_TRUE(guard.interrupted());
  ::raise(SIGHUP);
  ::raise(SIGHUP);
}

TEST(Interrupt, AnIgnoredHangUpStaysIgnored) {
  const auto before = ::signal(SIGHUP, SIG_IGN);  // as nohup does
  {
    const InterruptGuard guard;
    ::raise(SIGHUP);
    EXPECT_FALSE(guard.interrupted());
  }
  EXPECT_EQ(::signal(SIGHUP, before), SIG_IGN);
}

}  // namespace
}  // namespace aspic
