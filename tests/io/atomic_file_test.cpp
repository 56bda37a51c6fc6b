// Files that appear whole or not at all, where a file system or the rights of a user are in the way.

#include "io/atomic_file.h"

#include <cstddef>
#include <cstdlib>
#include <functional>

#include <grp.h>
#include <gtest/gtest.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include "solver/model/error.h"
#include "tests/support/result_file.h"
#include "tests/support/temp_folder.h"

namespace clerestory {
namespace {

namespace fs = std::filesystem;

constexpr int kCannot = 77;

/// Exit code of work() in a process of its own.
int apart(const std::function<int()>& work) {
  const pid_t child = fork();
  if (child == 0) _exit(work());
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

/// From now on no file system exchanges names.
bool forbid_exchange() {
  sock_filter program[] = {BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr)),
                           BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_renameat2, 0, 1),
                           BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | EINVAL),
                           BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW)};
  const sock_fprog filter{std::size(program), program};
  return prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 && prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &filter) == 0;
}

/// Commits a.txt, new.txt and one whose place has become a folder meanwhile.
int commit_in_vain(const TempFolder& folder) {
  Outputs outputs;
  for (const char* name : {"a.txt", "new.txt", "b.txt"}) outputs.open(folder / name).write("of today");
  fs::create_directory(folder / "b.txt");
  try {
    outputs.commit();
    return 1;
  } catch (const InputError&) {
    return 0;
  }
}

class AtomicFiles : public ::testing::TestWithParam<bool> {};

TEST_P(AtomicFiles, AreAllAsTheyWereWhenOneCannotBeNamed) {
  const TempFolder folder;
  folder.write("a.txt", "of yesterday");
  const int code = apart([&] { return GetParam() && !forbid_exchange() ? kCannot : commit_in_vain(folder); });
  if (code == kCannot) GTEST_SKIP() << "no seccomp";
  EXPECT_EQ(code, 0);
  EXPECT_EQ(read_text(folder / "a.txt"), "of yesterday");
  EXPECT_EQ(folder.listing(), "a.txt b.txt ");
}

TEST_P(AtomicFiles, AreReplacedAndLeaveNothingBehind) {
  const TempFolder folder;
  folder.write("a.txt", "of yesterday");
  const int code = apart([&] {
    if (GetParam() && !forbid_exchange()) return kCannot;
    write_file(folder / "a.txt", "of today");
    return 0;
  });
  if (code == kCannot) GTEST_SKIP() << "no seccomp";
  EXPECT_EQ(code, 0);
  EXPECT_EQ(read_text(folder / "a.txt"), "of today");
  EXPECT_EQ(folder.listing(), "a.txt ");
}

INSTANTIATE_TEST_SUITE_P(With, AtomicFiles, ::testing::Values(false, true),
                         [](const auto& test) { return std::string(test.param ? "HardLinks" : "AnExchange"); });

TEST(AtomicFile, OfAnotherOwnerKeepsTheGroupAndItsRightsWhereItCan) {
  if (geteuid() != 0) GTEST_SKIP() << "only root can make files of others";
  constexpr uid_t kOwner = 61'001, kWriter = 61'002;
  constexpr gid_t kShared = 62'001, kOther = 62'002, kOwn = 62'003;
  const TempFolder folder;
  chmod((folder / ".").c_str(), 0777);
  struct Case {
    gid_t group;
    mode_t before, after;
  };
  for (const auto& [group, before, after] :
       {Case{kShared, 0664, 0664}, Case{kShared, 0660, 0660}, Case{kOther, 0666, 0666}, Case{kOther, 0676, 0666}}) {
    const std::string file = folder.write("a.txt", "of yesterday");
    ASSERT_EQ(chown(file.c_str(), kOwner, group), 0);
    ASSERT_EQ(chmod(file.c_str(), before), 0);
    EXPECT_EQ(apart([&] {
                const gid_t groups[] = {kShared};
                if (setgroups(1, groups) != 0 || setgid(kOwn) != 0 || setuid(kWriter) != 0) return kCannot;
                write_file(file, "of today");
                return 0;
              }),
              0);
    struct stat status {};
    ASSERT_EQ(stat(file.c_str(), &status), 0);
    EXPECT_EQ(status.st_uid, kWriter);
    EXPECT_EQ(status.st_gid, group == kShared ? kShared : kOwn);
    EXPECT_EQ(status.st_mode & 07777u, after);
    fs::remove(file);
  }
}

}  // namespace
}  // namespace clerestory
