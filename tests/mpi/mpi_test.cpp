// freevoxels-mpi, started by Open MPI's mpirun as on a cluster, all ranks on this machine.

#include <fmt/format.h>

#include <csignal>
#include <cstdlib>
#include <sstream>
#include <thread>

#include "engine/image/image.h"
#include "tests/commands/program_runner.h"
#include "tests/limited_disk.h"

namespace freevoxels::test {

namespace {

class MpiTest : public CommandTest {
 protected:
  void SetUp() override {
    // One device thread a rank, as many ranks as wanted, also for root; no search for networks.
    setenv("LP_NUM_THREADS", "1", 1);
    setenv("OMPI_MCA_btl", "self,vader", 1);
    setenv("OMPI_ALLOW_RUN_AS_ROOT", "1", 1);
    setenv("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1", 1);
  }
  Arguments launch(int ranks, const std::string& text) const {
    Arguments arguments{"--map-by", ":OVERSUBSCRIBE", "--bind-to", "none", "-n", std::to_string(ranks), FREEVOXELS_MPI_PROGRAM};
    for (const std::string& word : words(text)) arguments.push_back(word);
    return arguments;
  }
  ProgramResult runMpi(int ranks, const std::string& text) const { return runProgramFile(FREEVOXELS_MPIRUN, launch(ranks, text)); }

  /// The ranks run this line of a shell, in which each can be treated in its own way.
  ProgramResult runScript(int ranks, const std::string& script) const {
    Arguments arguments = launch(ranks, "");
    arguments.pop_back();
    for (const char* word : {"/bin/sh", "-c", script.c_str()}) arguments.emplace_back(word);
    return runProgramFile(FREEVOXELS_MPIRUN, arguments);
  }

  /// This exit code, one sentence of the program's own among the launcher's, and no file more than before.
  void expectMpiRefusal(int ranks, const std::string& text, ExitCode code, const std::string& mention) const {
    SCOPED_TRACE(text);
    const std::size_t before = folder.fileCount();
    const ProgramResult result = runMpi(ranks, text);
    EXPECT_EQ(result.exitCode, int(code)) << result.err;
    EXPECT_EQ(sentences(result.err), 1) << result.err;
    EXPECT_NE(result.err.find(mention), std::string::npos) << result.err;
    EXPECT_EQ(folder.fileCount(), before) << "files were left behind";
  }
  static int sentences(const std::string& text) {
    int count = 0;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) count += line.starts_with("freevoxels-mpi: ") ? 1 : 0;
    return count;
  }
};

constexpr const char* kLit = "procedural:fire --resolution 24 --size 64x64 --light direction=1,1,0.5 --ambient 0.1 --lod 3 --quiet ";
constexpr const char* kInside =
    "procedural:cloud --resolution 24 --size 48x64 --camera-position 0.05,0.1,0 --look-at 0.3,0,-0.2 --light direction=1,1,0.5 --quiet ";

}  // namespace

TEST_F(MpiTest, AnyNumberOfRanksGivesTheBitsOfOneProcess) {
  expectSuccess(run("render " + std::string(kLit) + "@one.png @one.exr --float --aov depth --share 0/1"));
  const Image one = readExr(folder / "one.exr");
  for (const int ranks : {1, 2, 3, 4, 7}) {
    const ProgramResult result = runMpi(ranks, "render " + std::string(kLit) + "@all.png @all.exr --float --aov depth");
    ASSERT_EQ(result.exitCode, 0) << result.err;
    EXPECT_EQ(readBytes(folder / "all.png"), readBytes(folder / "one.png")) << ranks;
    const Image all = readExr(folder / "all.exr");
    EXPECT_EQ(all.pixels, one.pixels) << ranks;
    EXPECT_EQ(all.depth, one.depth) << ranks;
  }
}

TEST_F(MpiTest, AnEyeInsideSeesTheBitsOfMergedShares) {
  for (const char* index : {"0", "1"})
    expectSuccess(run("render " + std::string(kInside) + "@part" + index + ".exr --sums --share " + index + "/2"));
  expectSuccess(run("merge @part0.exr @part1.exr @merged.png --quiet"));
  expectSuccess(runMpi(3, "render " + std::string(kInside) + "@all.png"));
  EXPECT_EQ(readBytes(folder / "all.png"), readBytes(folder / "merged.png"));
}

/// 64 chunks of two channels: four stretches, which do not come out even for three ranks.
TEST_F(MpiTest, AnyNumberOfRanksBakesTheBytesOfOneProcess) {
  const std::string bake = "bake procedural:fire --resolution 97 --compress --quiet ";
  expectSuccess(run(bake + "@one.fvx"));
  const std::string expected = readBytes(folder / "one.fvx");
  for (const int ranks : {1, 2, 3}) {
    const ProgramResult result = runMpi(ranks, bake + "@all.fvx");
    ASSERT_EQ(result.exitCode, 0) << result.err;
    EXPECT_EQ(readBytes(folder / "all.fvx"), expected) << ranks;
  }
}

TEST_F(MpiTest, RanksWithLittleAndWithMuchMemoryDrawABakedVolumeInTheSameWay) {
  expectSuccess(run("bake procedural:cloud @a.fvx --resolution 96 --quiet"));
  const std::string render = "render @a.fvx --size 32 --float --quiet ";
  for (const std::string way : {"gather", "splats"}) {
    SCOPED_TRACE(way);
    expectSuccess(run(render + "@one.exr --share 0/1 --memory-limit 64 --draw " + way));
    std::string line = "exec " FREEVOXELS_MPI_PROGRAM;
    for (const std::string& word : words(render + "@all.exr --draw " + way)) line += " " + word;
    const ProgramResult result = runScript(2, line + " --memory-limit $((OMPI_COMM_WORLD_RANK == 0 ? 64 : 1024))");
    expectSuccess(result);
    EXPECT_EQ(readExr(folder / "all.exr").pixels, readExr(folder / "one.exr").pixels);
  }
  // Not even its box fits the first rank.
  std::string line = "exec " FREEVOXELS_MPI_PROGRAM;
  for (const std::string& word : words(render + "@none.exr --draw gather")) line += " " + word;
  const ProgramResult result = runScript(2, line + " --memory-limit $((OMPI_COMM_WORLD_RANK == 0 ? 1 : 1024))");
  EXPECT_EQ(result.exitCode, int(ExitCode::OutOfMemory)) << result.err;
  EXPECT_EQ(sentences(result.err), 1) << result.err;
}

TEST_F(MpiTest, FramesAreSplitOverGroupsOfRanks) {
  const std::string turn = "turntable procedural:cloud --resolution 24 --size 48x36 --frames 3 ";
  expectSuccess(run(turn + "@one_#.png --share 0/1 --quiet"));
  // Sums of a frame are added up while the next one is drawn.
  expectSuccess(runMpi(2, turn + "@both_#.png --quiet"));
  const ProgramResult result = runMpi(3, turn + "@all_#.png --ranks-per-frame 1");
  ASSERT_EQ(result.exitCode, 0) << result.err;
  std::string expected;
  for (const char* frame : {"0", "1", "2"}) {
    const std::string name = std::string("all_") + frame + ".png";
    EXPECT_EQ(readBytes(folder / name), readBytes(folder / (std::string("one_") + frame + ".png")));
    EXPECT_EQ(readBytes(folder / (std::string("both_") + frame + ".png")), readBytes(folder / name));
    expected += (folder / name).string() + "\n";
  }
  EXPECT_EQ(result.out, expected);  // once, by rank 0
}

TEST_F(MpiTest, AFlightIsTheSameForAnyNumberOfRanksAndOneForAllOfThem) {
  for (const char* last : {"0", "1"})
    writeBytes(folder / fmt::format("{}.json", last), fmt::format(R"({{"keys": [
        {{"time": -1, "camera-position": [1, 1, 2], "look-at": [0, 0, 0], "light": [{{"direction": [1, 1, 1]}}]}},
        {{"time": 2, "camera-position": [-1, {}, 2], "look-at": [0, 0, 0], "light": [{{"direction": [-1, 1, 1]}}]}}]}})",
                                                                  last));
  const std::string turn = "turntable procedural:cloud --resolution 24 --size 48x36 --frames 3 --quiet ";
  expectSuccess(run(turn + "@one_#.png --share 0/1 --flight @0.json"));
  expectSuccess(runMpi(2, turn + "@two_#.png --flight @0.json"));
  for (const char* frame : {"0", "1", "2"})
    EXPECT_EQ(readBytes(folder / fmt::format("two_{}.png", frame)), readBytes(folder / fmt::format("one_{}.png", frame))) << frame;
  std::string line = "exec " FREEVOXELS_MPI_PROGRAM;
  for (const std::string& word : words(turn + "@other_#.png --flight @$OMPI_COMM_WORLD_RANK.json")) line += " " + word;
  const ProgramResult result = runScript(2, line);
  EXPECT_EQ(result.exitCode, int(ExitCode::Input)) << result.err;
  EXPECT_NE(result.err.find("another flight"), std::string::npos) << result.err;
}

TEST_F(MpiTest, VerboseTellsLeastMeanAndMostOfEachStage) {
  const ProgramResult result = runMpi(2, "render procedural:cube --resolution 16 --size 32x32 @a.png --verbose");
  ASSERT_EQ(result.exitCode, 0) << result.err;
  EXPECT_EQ(result.out, (folder / "a.png").string() + "\n");
  for (const char* word : {"least", "mean", "most", "add up sums"}) EXPECT_NE(result.err.find(word), std::string::npos) << result.err;
}

TEST_F(MpiTest, ErrorsAreReportedOnceAndEndAllRanks) {
  expectMpiRefusal(2, "render @none.vdb @a.png", ExitCode::Input, "none.vdb");
  expectMpiRefusal(2, "render procedural:cube @none/a.png", ExitCode::Output, "none");
  expectMpiRefusal(2, "render procedural:cube @a.png --composite sorted", ExitCode::Usage, "sorted");
  expectMpiRefusal(2, "turntable procedural:cube @a_#.png --ranks-per-frame 3", ExitCode::Usage, "--ranks-per-frame");
}

/// Each rank reads a volume of its own: what a file system that has not caught up looks like.
TEST_F(MpiTest, RanksWithDifferentFilesAreRefused) {
  expectSuccess(run("generate cube @0.vdb --resolution 16 --quiet"));
  expectSuccess(run("generate cloud @1.vdb --resolution 16 --quiet"));
  const std::string command = std::string("exec ") + FREEVOXELS_MPI_PROGRAM + " render " + folder.path().string() +
                              "/$OMPI_COMM_WORLD_RANK.vdb " + (folder / "a.png").string() + " --density-scale 1 --size 32x32";
  const ProgramResult result = runScript(2, command);
  EXPECT_EQ(result.exitCode, int(ExitCode::Input)) << result.err;
  EXPECT_NE(result.err.find("rank 1"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("another volume"), std::string::npos) << result.err;
  EXPECT_FALSE(std::filesystem::exists(folder / "a.png"));
}

/// Rank 1 lacks memory for rays from the light and would look its shadows up in the table: sums that must not be added.
TEST_F(MpiTest, RanksWhoseDevicesNeedOtherMethodsAreRefused) {
  const ProgramResult result =
      runScript(2, "[ $OMPI_COMM_WORLD_RANK = 1 ] && less='--memory-limit 16'; exec " + std::string(FREEVOXELS_MPI_PROGRAM) +
                       " render procedural:cloud " + (folder / "a.png").string() +
                       " --resolution 96 --size 64 --light direction=1,1,0.3 --draw splats $less");
  EXPECT_EQ(result.exitCode, int(ExitCode::Input)) << result.err;
  EXPECT_NE(result.err.find("has a device that needs another method than rank 0"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("rank 1"), std::string::npos) << result.err;
  EXPECT_EQ(folder.fileCount(), 0u);
}

TEST_F(MpiTest, AFullDiskOfRankZeroEndsTheJobAndLeavesNoFile) {
  if (!canLimitDisks(folder.path())) GTEST_SKIP() << "this system does not allow a small tmpfs";
  const std::string disk = folder.path().string();
  const ProgramResult result =
      runScript(2, "run='exec " + std::string(FREEVOXELS_MPI_PROGRAM) + " render procedural:cloud " + (folder / "a.exr").string() +
                       " --resolution 24 --size 128 --float --quiet'; [ $OMPI_COMM_WORLD_RANK = 0 ] || eval $run; [ $(id -u) = 0 ] || root=-r; "
                       "exec unshare -m $root sh -c \"mount -t tmpfs -o size=16k none " + disk + " && $run\"");
  EXPECT_EQ(result.exitCode, int(ExitCode::Output)) << result.err;
  EXPECT_EQ(sentences(result.err), 1) << result.err;
  EXPECT_NE(result.err.find("a.exr"), std::string::npos) << result.err;
  EXPECT_EQ(folder.fileCount(), 0u);
}

/// The scripts for Slurm as it runs them, but with mpirun in the place of srun, and the tasks of the array one after the other.
TEST_F(MpiTest, TheJobScriptsForSlurmDrawTheSameImage) {
  writeBytes(folder / "srun",
             "#!/bin/sh\n[ \"$1 $2\" = '--mpi=pmix --kill-on-bad-exit=1' ] || exit 99\nshift 2\n"
             "exec '" FREEVOXELS_MPIRUN "' --map-by :OVERSUBSCRIBE --bind-to none -n 2 \"$@\"\n");
  std::filesystem::permissions(folder / "srun", std::filesystem::perms::owner_all);
  const std::string programs = std::filesystem::path(FREEVOXELS_MPI_PROGRAM).parent_path().string();
  const std::string script = "set -e; cd '" + folder.path().string() + "'; PATH='" + folder.path().string() + ":" + programs + "':$PATH\n"
                             "freevoxels generate cube a.vdb --resolution 12 --quiet\n"
                             "bash " FREEVOXELS_JOB_SCRIPTS "/mpi_job.sh a.vdb all.png --size 32 --quiet\n"
                             "export SLURM_ARRAY_TASK_MIN=5 SLURM_ARRAY_TASK_COUNT=2\n"
                             "for task in 5 6; do SLURM_ARRAY_TASK_ID=$task bash " FREEVOXELS_JOB_SCRIPTS "/array_job.sh a.vdb --size 32 --quiet; done\n"
                             "freevoxels merge part_*.exr merged.png --quiet\n";
  const ProgramResult result = runProgramFile("/bin/sh", {"-c", script});
  ASSERT_EQ(result.exitCode, 0) << result.err;
  EXPECT_EQ(readBytes(folder / "merged.png"), readBytes(folder / "all.png"));
}

TEST_F(MpiTest, ProcessesThatDoNotKnowEachOtherAreRefused) {
  setenv("SLURM_STEP_NUM_TASKS", "4", 1);
  const ProgramResult result = runProgramFile(FREEVOXELS_MPI_PROGRAM, words("render procedural:cube @a.png"));
  unsetenv("SLURM_STEP_NUM_TASKS");
  EXPECT_EQ(result.exitCode, int(ExitCode::Usage)) << result.err;
  EXPECT_NE(result.err.find("4 processes were started, but each is alone"), std::string::npos) << result.err;
  EXPECT_EQ(folder.fileCount(), 0u);
}

TEST_F(MpiTest, AKilledRankEndsTheJobAndLeavesNoFile) {
  // Rank 1 is killed while the others draw.
  const std::string command = std::string("if [ $OMPI_COMM_WORLD_RANK = 1 ]; then (sleep 1; kill -9 $$) & fi; exec ") +
                              FREEVOXELS_MPI_PROGRAM + " turntable procedural:cloud --resolution 48 --size 512x512 --frames 1000 " +
                              (folder / "a_####.exr").string() + " --quiet";
  const auto start = std::chrono::steady_clock::now();
  const ProgramResult result = runScript(3, command);
  EXPECT_NE(result.exitCode, 0);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(20));
  for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
    EXPECT_EQ(readExr(entry.path()).size, glm::ivec2(512, 512)) << entry.path();  // whole frames only
}

}  // namespace freevoxels::test
