#include "apps/view/export_job.h"

#include <gtest/gtest.h>

#include <future>
#include <semaphore>

#include "engine/core/error.h"

namespace freevoxels {
namespace {

class ExportJobTest : public ::testing::Test {
 protected:
  ExportJob::Outcome outcome() {
    ended.acquire();
    return job.take().value();
  }

  std::binary_semaphore ended{0};
  ExportJob job{[this] { ended.release(); }};
};

TEST_F(ExportJobTest, SaysWhatWasDone) {
  job.start([](const Progress& progress) { progress("half", 0.5); }, "saved");
  const ExportJob::Outcome result = outcome();
  EXPECT_TRUE(result.done);
  EXPECT_EQ(result.sentence, "saved");
  EXPECT_FALSE(job.busy());
  EXPECT_FALSE(job.take());
}

TEST_F(ExportJobTest, SaysWhyNothingWas) {
  job.start([](const Progress&) { fail(ErrorKind::Output, "no room for {}", "it"); }, "saved");
  const ExportJob::Outcome result = outcome();
  EXPECT_FALSE(result.done);
  EXPECT_EQ(result.sentence, "no room for it");
}

TEST_F(ExportJobTest, IsGivenUpWhereItSaysHowFarItIs) {
  std::promise<void> begun;
  job.start(
      [&](const Progress& progress) {
        for (int i = 0;; ++i) {
          progress("frame", 0.25);
          if (i == 0) begun.set_value();
        }
      },
      "saved");
  begun.get_future().wait();
  EXPECT_TRUE(job.busy());
  EXPECT_EQ(job.activity(), (std::pair<std::string, double>("frame", 0.25)));
  job.cancel();
  EXPECT_FALSE(outcome().done);
  job.start([](const Progress& progress) { progress("again", 0.0); }, "saved");
  EXPECT_TRUE(outcome().done) << "what was given up is not the next";
}

}  // namespace
}  // namespace freevoxels
