// SPDX-License-Identifier: Apache-2.0
#include "bench/bus/topic_exchange.hpp"

#include <fmt/format.h>

#include <chrono>
#include <utility>

#include "armature/messages/sensor_msgs.hpp"
#include "armature/runtime/component/setup.hpp"
#include "armature/values/wake_up.hpp"

namespace armature::bench {

/// One end of the questions and answers with one QoS.
struct ExchangePorts {
  Input<msg::Image> in;
  Output<msg::Image> out;
};

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::string_view kAskPlugin = R"(
armature_plugin: 1
id: bench/ask
kind: component
pure: false
doc: Asks, for `armature bench bus`.
in:
  state_answer: {type: sensor_msgs/Image, topic: state_answer, reads: latest, trigger: true, feedback: true, optional: true, doc: "To its own questions."}
  sensor_answer: {type: sensor_msgs/Image, topic: sensor_answer, reads: latest, trigger: true, qos: sensor, feedback: true, optional: true, doc: "The same."}
out:
  state_question: {type: sensor_msgs/Image, topic: state_question, doc: "Answered."}
  sensor_question: {type: sensor_msgs/Image, topic: sensor_question, qos: sensor, doc: "Answered."}
)";

constexpr std::string_view kAnswerPlugin = R"(
armature_plugin: 1
id: bench/answer
kind: component
doc: Answers, for `armature bench bus`.
in:
  state_question: {type: sensor_msgs/Image, topic: state_question, reads: latest, trigger: true, optional: true, doc: "Answered."}
  sensor_question: {type: sensor_msgs/Image, topic: sensor_question, reads: latest, trigger: true, qos: sensor, optional: true, doc: "Answered."}
out:
  state_answer: {type: sensor_msgs/Image, topic: state_answer, doc: "To a question."}
  sensor_answer: {type: sensor_msgs/Image, topic: sensor_answer, qos: sensor, doc: "The same."}
)";

/// Publishes a message of that number and size, whose bytes an earlier use has left.
void send(Output<msg::Image>& out, std::uint32_t number, std::size_t bytes) {
  auto loan = out.loan();
  loan->step_(number);
  loan->data_().resize(bytes);
  loan.publish();
}

class Answerer final : public Component {
 public:
  explicit Answerer(Setup& setup)
      : Component{setup},
        state_{setup.input<msg::Image>("state_question"), setup.output<msg::Image>("state_answer")},
        sensor_{setup.input<msg::Image>("sensor_question"),
                setup.output<msg::Image>("sensor_answer")} {}
  void step(Time) override {
    for (ExchangePorts* ports : {&state_, &sensor_}) {
      if (!ports->in.fresh()) continue;
      const msg::Image& question = *ports->in.latest();
      send(ports->out, question.step_(), question.data_().size());
    }
  }

 private:
  ExchangePorts state_, sensor_;
};

}  // namespace

/// What asks; a thread that is not its executor's says how often.
class Asker final : public Component {
 public:
  struct Order {
    bool pictures = false;
    std::size_t bytes = 0;
    int count = 0;
    int number = 0;  // of the order
  };

  explicit Asker(Setup& setup)
      : Component{setup},
        state_{setup.input<msg::Image>("state_answer"), setup.output<msg::Image>("state_question")},
        sensor_{setup.input<msg::Image>("sensor_answer"),
                setup.output<msg::Image>("sensor_question")},
        orders_{setup.driver_thread<Order>(1, [this] { pass_orders(); })} {}

  void step(Time) override {
    const Clock::time_point now = Clock::now();
    if (const auto order = orders_.take()) {
      order_ = order->sample;
      times_.clear();
      times_.reserve(static_cast<std::size_t>(order_.count));
      ask();
      return;
    }
    ExchangePorts& ports = order_.pictures ? sensor_ : state_;
    if (order_.count == 0 || !ports.in.fresh() || ports.in.latest()->step_() != number_) return;
    times_.push_back(std::chrono::duration<double>(now - asked_).count());
    if (--order_.count > 0) {
      ask();
    } else {
      done_order_ = order_.number;
      done_.notify();
    }
  }

  /// Waits until the order is done, or for as many seconds as it has questions.
  std::vector<double> obey(const Order& order) {
    given_ = order;
    given_.number = ++orders_given_;
    go_.notify();
    const auto end = Clock::now() + std::chrono::seconds{1} * order.count;
    while (done_order_ != given_.number) {
      if (!done_.wait_until(end)) return {};
    }
    return std::exchange(times_, {});
  }

 private:
  void pass_orders() {
    while (!orders_.stopping()) {
      if (go_.wait_until(Clock::now() + std::chrono::milliseconds{50})) {
        orders_.push(orders_.now(), given_);
      }
    }
  }
  void ask() {
    asked_ = Clock::now();
    send((order_.pictures ? sensor_ : state_).out, ++number_, order_.bytes);
  }

  ExchangePorts state_, sensor_;
  DriverQueue<Order>& orders_;
  Order given_, order_;
  std::uint32_t number_ = 0;
  Clock::time_point asked_;
  std::vector<double> times_;
  int orders_given_ = 0;
  std::atomic<int> done_order_{0};
  WakeUp go_, done_;
};

namespace {

std::string text_of(const TopicExchange::Settings& settings) {
  const bool both = settings.part == TopicExchange::Part::both;
  // An executor goes where its process is put, unless both are in one.
  const auto cpu = [&](int number) { return both ? fmt::format("cpu: {}", number) : ""; };
  return fmt::format(
      "armature: 1\n"
      "name: {}\n"
      "executors: {{ask: {{{}}}, answer: {{{}}}}}\n"
      "components:\n"
      "  ask: {{plugin: bench/ask, executor: ask}}\n"
      "  answer: {{plugin: bench/answer, executor: answer{}}}\n",
      both ? "bench_bus_inside" : "bench_bus", cpu(settings.ask_cpu), cpu(settings.answer_cpu),
      both ? "" : ", process: other");
}

}  // namespace

TopicExchange::TopicExchange(const Settings& settings) {
  plugins_.add<Asker>(kAskPlugin);
  plugins_.add<Answerer>(kAnswerPlugin);
  Deployment::Options options;
  if (settings.part == Part::answers) options.process = "other";
  running_.emplace(text_of(settings), plugins_, std::move(options), settings.domain);
  if (ComponentRunner* runner = running_->find("ask")) {
    asker_ = &dynamic_cast<Asker&>(runner->component());
  }
  running_->start();
}

std::vector<double> TopicExchange::round_trips(QosProfile qos, std::size_t bytes, int count) {
  return asker_->obey({.pictures = qos == QosProfile::sensor, .bytes = bytes, .count = count});
}

}  // namespace armature::bench
