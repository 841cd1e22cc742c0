// SPDX-License-Identifier: Apache-2.0
// A solver that runs alone as a component answers a program that has only DDS.
#include <gtest/gtest.h>

#include <chrono>
#include <condition_variable>
#include <csignal>
#include <mutex>
#include <thread>

#include "armature/bus/fast_dds/fast_dds_transport.hpp"
#include "armature/messages/armature_msgs.hpp"
#include "command.hpp"
#include "tests/dds_domain.hpp"

namespace armature::test {
namespace {

using std::chrono::seconds;

Time system_now() {
  return Time{
      std::chrono::duration_cast<Duration>(std::chrono::system_clock::now().time_since_epoch())
          .count()};
}

/// The asking program: another deployment, or none at all, as far as the solver is concerned.
class Asker {
 public:
  explicit Asker(int domain)
      : transport_{std::move(
            *FastDdsTransport::make({.domain = domain, .deployment = "asker", .now = system_now}))},
        requests_{message_type<msg::IkRequest>(), 4},
        writer_{std::move(*transport_->advertise(
            {"rt/ik_alone/ik/request", &message_type<msg::IkRequest>(), QosProfile::command}))},
        reader_{std::move(*transport_->subscribe(
            {"rt/ik_alone/ik/response", &message_type<msg::IkResponse>(), QosProfile::command},
            false, [this](const SampleRef& sample) { keep(sample); }))} {}

  bool connected(seconds patience) const {
    for (const auto end = std::chrono::steady_clock::now() + patience;
         std::chrono::steady_clock::now() < end;) {
      if (writer_->watchers() > 0 && reader_->writers() > 0) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds{20});
    }
    return false;
  }

  /// An answer without a status: none came.
  msg::IkResponse ask(const msg::IkRequest& request) {
    SampleRef sample = requests_.loan();
    *static_cast<msg::IkRequest*>(sample.mutable_message()) = request;
    sample.mutable_info().published = system_now();
    std::unique_lock lock{mutex_};
    response_ = {};
    writer_->offer(sample);
    answered_.wait_for(lock, seconds{20}, [&] { return !response_.status_().empty(); });
    return response_;
  }

 private:
  void keep(const SampleRef& sample) {
    const std::scoped_lock lock{mutex_};
    response_ = *static_cast<const msg::IkResponse*>(sample.message());
    answered_.notify_all();
  }

  std::mutex mutex_;
  std::condition_variable answered_;
  msg::IkResponse response_;
  std::unique_ptr<Transport> transport_;
  SamplePool requests_;  // outlives the writer, which may still be sending
  std::unique_ptr<OutsideWriter> writer_;
  std::unique_ptr<OutsideReader> reader_;
};

/// The paper's example.
msg::IkRequest paper_request() {
  msg::IkRequest request;
  request.request_id_(7);
  request.position_().x_(1.3);
  request.position_().y_(0.321);
  request.position_().z_(0.504);
  request.pointing_(true);
  request.direction_().x_(0.894427);
  request.direction_().y_(-0.268328);
  request.direction_().z_(-0.357771);
  return request;
}

class StandaloneIk : public testing::Test {
 protected:
  void SetUp() override { ASSERT_TRUE(asker_.connected(seconds{30})) << solver_.err(); }
  int domain_ = unique_dds_domain();
  Command solver_{{armature(), "run", source_file("tests/end_to_end/ik_alone.yaml"), "--domain",
                   std::to_string(domain_)}};
  Asker asker_{domain_};
};

TEST_F(StandaloneIk, AnswersARequestOverDdsWithAllBranches) {
  const msg::IkResponse response = asker_.ask(paper_request());
  EXPECT_EQ(response.request_id_(), 7U);
  EXPECT_EQ(response.status_(), "ok") << response.reason_();
  ASSERT_GE(response.solutions_().size(), 2U);
  const msg::IkSolution& first = response.solutions_()[0];
  EXPECT_EQ(first.label_(), "tilt0/balance0/elbow0");
  const std::vector<double> paper{1.1435, -1.3390, 0.0476, -0.0476, -0.0960, -0.3659};
  ASSERT_EQ(first.joints_().size(), paper.size());
  for (std::size_t i = 0; i < paper.size(); ++i) EXPECT_NEAR(first.joints_()[i], paper[i], 1e-4);
  EXPECT_LT(first.residual_m_(), 1e-9);
  EXPECT_TRUE(first.within_limits_());

  msg::IkRequest far_away = paper_request();
  far_away.request_id_(8);
  far_away.position_().x_(9);
  const msg::IkResponse refused = asker_.ask(far_away);
  EXPECT_EQ(refused.request_id_(), 8U);
  EXPECT_EQ(refused.status_(), "out_of_reach");
  EXPECT_NE(refused.reason_(), "");
  EXPECT_TRUE(refused.solutions_().empty());

  solver_.signal(SIGINT);
  EXPECT_EQ(solver_.finish(seconds{10}).exit_code, 0) << "it has no goals: an end is an end";
}

}  // namespace
}  // namespace armature::test
