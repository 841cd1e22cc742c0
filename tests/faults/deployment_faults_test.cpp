// SPDX-License-Identifier: Apache-2.0
// Faulty deployments: each is one change of base.yaml, and gives its exact messages, with line and
// column, and exit code 3 before anything is started.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "armature/values/file_content.hpp"
#include "armature/values/temporary_folder.hpp"
#include "command.hpp"

namespace armature::test {
namespace {

namespace fs = std::filesystem;

struct Fault {
  const char* name;
  const char* from;  // this text of base.yaml
  const char* to;    // is replaced by this
  const char* messages;
};

void PrintTo(const Fault& fault, std::ostream* out) { *out << fault.name; }

const Fault kFaults[] = {
    {"UnknownKeyAtTheTop", "clock: simulated", "clok: simulated",
     "deployment.yaml:3:1: unknown key 'clok' in the deployment; did you mean 'clock'?\n"},
    {"UnknownKeyInAComponent", "  face: {plugin: face_pose/three_point}",
     "  face: {plugn: face_pose/three_point}",
     "deployment.yaml:10:10: unknown key 'plugn' in component 'face'; did you mean 'plugin'?\n"},
    {"UnknownKeyBesideAPlugin", "executor: control}", "executr: control}",
     "deployment.yaml:20:32: unknown key 'executr' in component 'arm'; did you mean 'executor'?\n"},
    {"DuplicateKey", "clock: simulated", "name: again",
     "deployment.yaml:3:1: 'name' is given twice; first at deployment.yaml:2:1\n"},
    {"DuplicateComponent", "  face: {plugin: face_pose/three_point}",
     "  face: {plugin: face_pose/three_point}\n  face: {plugin: face_pose/three_point}",
     "deployment.yaml:11:3: 'face' is given twice; first at deployment.yaml:10:3\n"},
    {"UnknownPlugin", "plugin: ik/lamp_geometric", "plugin: ik/lamp_geometrik",
     "deployment.yaml:17:18: unknown plugin 'ik/lamp_geometrik'; did you mean "
     "'ik/lamp_geometric'?\n"},
    {"PluginThatIsAList", "plugin: ik/lamp_geometric", "plugin: [ik/lamp_geometric]",
     "deployment.yaml:17:18: 'plugin' must be the id of a plugin, family/name, not a list\n"},
    {"PluginThatIsEmpty", "{plugin: face_pose/three_point}", "{plugin: ''}",
     "deployment.yaml:10:18: 'plugin' must be the id of a plugin, family/name, not an empty "
     "text\n"},
    {"PluginWithoutAValue", "{plugin: ik/lamp_geometric}", "{plugin: }",
     "deployment.yaml:17:10: 'plugin' must be the id of a plugin, family/name, not nothing\n"},
    {"RobotThatIsAList", "{plugin: arm/simulated, executor: control}",
     "{plugin: arm/simulated, executor: control, robot: [arm]}",
     "deployment.yaml:20:58: 'robot' must name an entry of 'robots', not a list\n"},
    {"ARateThatIsNotItsExecutors", "{plugin: arm/simulated, executor: control}",
     "{plugin: arm/simulated, executor: control, params: {rate_hz: 250}}",
     "deployment.yaml:20:3: component 'arm' steps every 0.004 s by itself, but its executor "
     "'control' steps every 0.001 s; make both the same, or name an executor without a period\n"},
    {"PluginOfAnotherKindInASlot", "plugin: ik/lamp_geometric", "plugin: select/nearest",
     "deployment.yaml:17:18: 'select/nearest' is of kind 'select', slot 'ik' takes kind 'ik'\n"},
    {"MissingSlot", "    select: {plugin: select/nearest}\n", "",
     "deployment.yaml:13:3: component 'motion' needs a plugin in its slot 'select': add 'select: "
     "{plugin: select/...}'\n"},
    {"ParameterWithAnotherUnit", "distance_m: 0.5", "distance_mm: 0.5",
     "deployment.yaml:12:48: unknown key 'distance_mm' in params of 'task/lamp_alignment'; did you "
     "mean 'distance_m'?\n"},
    {"ParameterTypo", "photo: generated", "foto: generated",
     "deployment.yaml:8:45: unknown key 'foto' in params of 'sim/photo_scene'; did you mean "
     "'photo'?\n"},
    {"ParameterWrongType", "distance_m: 0.5", "distance_m: half",
     "deployment.yaml:12:60: 'distance_m' must be a number, not 'half'\n"},
    {"ParameterOutOfRange", "tilt_up_deg: 0", "tilt_up_deg: 120",
     "deployment.yaml:8:76: 'tilt_up_deg' is 120, must be from -90 to 90\n"},
    {"AThresholdThatNothingMeets",
     "{plugin: task/lamp_alignment, params: {distance_m: 0.5, auto_confirm: true}}",
     "{plugin: task/lamp_alignment, params: {settled_position_mm: 0}}",
     "deployment.yaml:12:69: 'settled_position_mm' is 0, must be at least 0.001\n"},
    {"ParameterUnknownChoice", "photo: generated", "photo: astronout",
     "deployment.yaml:8:52: 'photo' cannot be 'astronout'; did you mean 'astronaut'?\n"},
    {"ParameterNaN", "distance_m: 0.5", "distance_m: .nan",
     "deployment.yaml:12:60: 'distance_m' must be a number, not '.nan'; it must be finite\n"},
    {"ParameterOctal", "distance_m: 0.5", "distance_m: 010",
     "deployment.yaml:12:60: 'distance_m' must be a number, and '010' is octal to some readers; "
     "write 10\n"},
    {"UnknownWordForAFault", "executor: control}", "executor: control, on_fault: ignore}",
     "deployment.yaml:20:61: 'on_fault' cannot be 'ignore'; known: stop, isolate\n"},
    {"UnknownExecutor", "executor: control}", "executor: contrl}",
     "deployment.yaml:20:42: unknown executor 'contrl'; did you mean 'control'?\n"},
    {"PeriodOfZero", "period_s: 0.001", "period_s: 0",
     "deployment.yaml:6:33: 'period_s' is 0, must be from 0.0001 to 3600\n"},
    {"PeriodThatIsNoNumber", "period_s: 0.001", "period_s: abc",
     "deployment.yaml:6:33: 'period_s' must be a number, not 'abc'\n"},
    {"PeriodThatNobodyWaitsFor", "period_s: 0.001", "period_s: 1e300",
     "deployment.yaml:6:33: 'period_s' is 1e+300, must be from 0.0001 to 3600\n"},
    {"NegativeTimeLimit", "clock: simulated", "run: {time_limit_s: -1}",
     "deployment.yaml:3:21: 'time_limit_s' is -1, must be at least 0: 0 is no limit\n"},
    {"NoTimeToStop", "clock: simulated", "run: {stop_within_s: 0}",
     "deployment.yaml:3:22: 'stop_within_s' is 0, must be from 0.1 to 3600: what moves comes to "
     "rest before anything ends\n"},
    {"EndlessTimeToStop", "clock: simulated", "run: {stop_within_s: 1e300}",
     "deployment.yaml:3:22: 'stop_within_s' is 1e+300, must be from 0.1 to 3600: what moves comes "
     "to rest before anything ends\n"},
    {"NegativeSeed", "clock: simulated", "seed: -1",
     "deployment.yaml:3:7: 'seed' must be a whole number from 0 to 18446744073709551615, not "
     "'-1'\n"},
    {"SeedBeyond64Bits", "clock: simulated", "seed: 18446744073709551616",
     "deployment.yaml:3:7: 'seed' must be a whole number from 0 to 18446744073709551615, not "
     "'18446744073709551616'\n"},
    {"SeedThatIsNotWhole", "clock: simulated", "seed: 1.5",
     "deployment.yaml:3:7: 'seed' must be a whole number from 0 to 18446744073709551615, not "
     "'1.5'\n"},
    {"NegativePeriod", "period_s: 0.001", "period_s: -0.001",
     "deployment.yaml:6:33: 'period_s' is -0.001, must be from 0.0001 to 3600\n"},
    {"UnknownClock", "clock: simulated", "clock: simulatd",
     "deployment.yaml:3:8: 'clock' cannot be 'simulatd'; did you mean 'simulated'?\n"},
    {"RenameOfNoInput", "{plugin: face_pose/three_point}",
     "{plugin: face_pose/three_point, in: {landmark: face/points}}",
     "deployment.yaml:10:46: component 'face' has no input 'landmark'; did you mean "
     "'landmarks'?\n"},
    {"RenameOfNoOutput", "{plugin: face_pose/three_point}",
     "{plugin: face_pose/three_point, out: {pose: face/pose}}",
     "deployment.yaml:10:47: component 'face' has no output 'pose'; known: face\n"},
    {"InputNobodyWrites", "{plugin: face_pose/three_point}",
     "{plugin: face_pose/three_point, in: {landmarks: landmark}}",
     "deployment.yaml:10:57: face.landmarks reads topic '/faulty/landmark', which nobody writes; "
     "did you mean '/faulty/landmarks'?\n"},
    {"TwoTypesOnOneTopic", "{plugin: face_pose/three_point}",
     "{plugin: face_pose/three_point, in: {landmarks: left/image_raw}}",
     "deployment.yaml:10:57: face.landmarks reads type 'armature_msgs/FaceLandmarks' from topic "
     "'/faulty/left/image_raw', but scene.left_image writes type 'sensor_msgs/Image'\n"},
    {"TwoWritersOfOneTopic", "{plugin: face_pose/three_point}",
     "{plugin: face_pose/three_point, out: {face: landmarks}}",
     "deployment.yaml:10:53: landmarks.landmarks and face.face both write topic "
     "'/faulty/landmarks'; give one of them others "
     "with 'topics:' or 'out:'\n"
     "deployment.yaml:11:3: target.face reads topic '/faulty/face', which nobody writes\n"
     "deployment.yaml:21:3: report.face reads topic '/faulty/face', which nobody writes\n"},
    {"OptionalInputRenamedToWhatNobodyWrites", "executor: control}",
     "executor: control, in: {servo_jp: arm/servo}}",
     "deployment.yaml:20:66: arm.servo_jp reads topic '/faulty/arm/servo', which nobody writes; "
     "did "
     "you mean '/faulty/arm/servo_jp'?\n"},
    {"SharedTopicWithAWriterThatDoesNotShareIt", "executor: control}",
     "executor: control}\n  monitor: {plugin: monitor/rviz, out: {tool_pose: /tf}}",
     "deployment.yaml:21:52: monitor.tf and monitor.tool_pose both write topic '/tf'; give one of "
     "them others with 'topics:' or 'out:'\n"},
    {"UnknownRigWhereNoneIsNeeded", "executor: control}",
     "executor: control}\n  monitor: {plugin: monitor/rviz, rig: lft}",
     "deployment.yaml:21:40: unknown rig 'lft'; known: head\n"},
    {"FrameCalledAsAnotherOne", "executor: control}",
     "executor: control}\n  monitor: {plugin: monitor/rviz, params: {world_frame: tool}}",
     "deployment.yaml:21:3: component 'monitor': two frames would be called 'tool'\n"},
    {"BasePlacedInNoWorld", "executor: control}",
     "executor: control}\n  monitor: {plugin: monitor/rviz, params: {base_position_m: [1, 0, 0]}}",
     "deployment.yaml:21:61: 'base_position_m' and 'base_rpy_deg' place base in 'world_frame': "
     "name "
     "one\n"},
    {"NameOfTheRuntimesOwn", "  arm: {", "  runtime: {",
     "deployment.yaml:20:3: 'runtime' is a component of the runtime; choose another name\n"},
    {"RobotFileMissing", "robots/dental_lamp.yaml", "robots/dental_lmap.yaml",
     "deployment.yaml:4:15: cannot read 'robots/dental_lmap.yaml': No such file or directory\n"},
    {"NoRobot", "robots: {arm: @CONFIGS@/robots/dental_lamp.yaml}\n", "",
     "deployment.yaml:7:3: component 'scene' needs a robot: add 'robots: {name: file.yaml}'\n"
     "deployment.yaml:10:3: component 'target' needs a robot: add 'robots: {name: file.yaml}'\n"
     "deployment.yaml:11:3: component 'task' needs a robot: add 'robots: {name: file.yaml}'\n"
     "deployment.yaml:12:3: component 'motion' needs a robot: add 'robots: {name: file.yaml}'\n"
     "deployment.yaml:19:3: component 'arm' needs a robot: add 'robots: {name: file.yaml}'\n"
     "deployment.yaml:20:3: component 'report' needs a robot: add 'robots: {name: file.yaml}'\n"},
    {"TwoRobotsUnnamed", "robots: {arm: @CONFIGS@/robots/dental_lamp.yaml}",
     "robots: {arm: @CONFIGS@/robots/dental_lamp.yaml, left: @CONFIGS@/robots/dental_lamp.yaml}",
     "deployment.yaml:8:3: component 'scene' must say which robot: 'robot: ...'\n"
     "deployment.yaml:11:3: component 'target' must say which robot: 'robot: ...'\n"
     "deployment.yaml:12:3: component 'task' must say which robot: 'robot: ...'\n"
     "deployment.yaml:13:3: component 'motion' must say which robot: 'robot: ...'\n"
     "deployment.yaml:20:3: component 'arm' must say which robot: 'robot: ...'\n"
     "deployment.yaml:21:3: component 'report' must say which robot: 'robot: ...'\n"},
    {"UnknownRobot", "{plugin: arm/simulated, executor: control}",
     "{plugin: arm/simulated, executor: control, robot: lamp}",
     "deployment.yaml:20:58: unknown robot 'lamp'; known: arm\n"},
    {"NotADeployment", "armature: 1\n", "",
     "deployment.yaml:1:1: not a deployment: it must begin with 'armature: 1'\n"},
    {"WrongVersion", "armature: 1", "armature: 2",
     "deployment.yaml:1:11: 'armature' is 2, must be 1: the format that this version reads\n"},
    {"NameWithSlash", "name: faulty", "name: lamp/one",
     "deployment.yaml:2:7: 'lamp/one' must consist of letters, digits and '_', and begin with no "
     "digit: it is the namespace of the topics\n"},
    {"NameThatIsEmpty", "name: faulty", "name: ''",
     "deployment.yaml:2:7: '' must consist of letters, digits and '_', and begin with no digit: it "
     "is the namespace of the topics\n"},
    {"NameThatIsTooLongForDds", "name: faulty",
     "name: a123456789a123456789a123456789a123456789a123456789a123456789a1234",
     "deployment.yaml:2:7: 'a123456789a12345...' has 65 letters, and a name has at most 64: it is "
     "the namespace of the topics\n"},
    {"TabForIndentation", "    executor: control", "	executor: control",
     "deployment.yaml:14:2: cannot be read as YAML: end of map not found; indent with spaces, not "
     "tabs\n"},
    {"MergeKey", "  face: {plugin: face_pose/three_point}",
     "  face:\n    <<: {plugin: face_pose/three_point}",
     "deployment.yaml:11:5: '<<' merges are not read; use 'include:' at the top of the file for "
     "shared values\n"},
    {"Anchor", "  face: {plugin: face_pose/three_point}",
     "  face: &f {plugin: face_pose/three_point}",
     "deployment.yaml:10:9: anchors ('&name') are not read; use 'include:', or put a text in "
     "quotes\n"},
    {"EnvironmentUnset", "distance_m: 0.5", "distance_m: ${ARMATURE_TEST_UNSET}",
     "deployment.yaml:12:60: the environment variable 'ARMATURE_TEST_UNSET' is not set; set it or "
     "write ${ARMATURE_TEST_UNSET:-default}\n"},
    {"ProcessOnSimulatedClock", "{plugin: face_pose/three_point}",
     "{plugin: face_pose/three_point, process: vision}",
     "deployment.yaml:10:50: the simulated clock runs one process; remove 'process' or set 'clock: "
     "system'\n"},
    {"ImpurePluginOnSimulatedClock", "plugin: ik/lamp_geometric",
     "plugin: ik/process, params: {command: [solver]}",
     "deployment.yaml:17:18: on the simulated clock a run is the same every time, and 'ik/process' "
     "cannot promise that (its plugin.yaml says 'pure: false'); choose another plugin or set "
     "'clock: system'\n"},
    {"ImpurePluginAloneOnSimulatedClock", "components:\n",
     "components:\n  alone: {plugin: ik/process, params: {command: [solver]}}\n",
     "deployment.yaml:8:19: on the simulated clock a run is the same every time, and 'ik/process' "
     "cannot promise that (its plugin.yaml says 'pure: false'); choose another plugin or set "
     "'clock: system'\n"},
    {"CommandThatIsNoList", "plugin: ik/lamp_geometric}",
     "plugin: ik/process, params: {command: solver}}",
     "deployment.yaml:17:18: on the simulated clock a run is the same every time, and 'ik/process' "
     "cannot promise that (its plugin.yaml says 'pure: false'); choose another plugin or set "
     "'clock: system'\n"
     "deployment.yaml:17:48: 'command' must be a list of texts, not 'solver'\n"},
    {"VelocityAboveTheRobots", "max_velocity_rad_s: 1.0", "max_velocity_rad_s: 9.0",
     "deployment.yaml:15:34: max_velocity_rad_s is 9, above the 2.5 rad/s of joint j1 of robot "
     "dental_lamp\n"},
    {"GoalNotANumber", "distance_error_mm: 1.5", "distance_error_mm: small",
     "deployment.yaml:22:28: 'distance_error_mm' must be a number, not 'small'\n"},
    {"ComponentsMissing", "components:", "component:",
     "deployment.yaml:1:1: missing key 'components' in the deployment\n"
     "deployment.yaml:7:1: unknown key 'component' in the deployment; did you mean "
     "'components'?\n"},
    {"Cycle", "  face: {plugin: face_pose/three_point}",
     "  face: {plugin: face_pose/three_point, in: {landmarks: face}}",
     "deployment.yaml:10:3: a cycle without a declared delay among face, target, task, motion, "
     "motion.planner, arm, report: one input in it must be 'feedback: true' in its plugin.yaml\n"
     "deployment.yaml:10:57: face.landmarks reads type 'armature_msgs/FaceLandmarks' from topic "
     "'/faulty/face', but face.face writes type 'armature_msgs/FacePose'\n"},
    {"IncludeMissing", "clock: simulated", "include: nowhere.yaml",
     "deployment.yaml:3:10: cannot read 'nowhere.yaml': No such file or directory\n"},
    {"ParameterWithoutAValue", "photo: generated",
     "photo: ", "deployment.yaml:8:45: 'photo' must be a text, not nothing\n"},
    {"PortWithoutATopic", "{plugin: face_pose/three_point}",
     "{plugin: face_pose/three_point, in: {landmarks: null}}",
     "deployment.yaml:10:57: the topic of input 'landmarks' must be a text, not nothing\n"},
    {"TopicThatIsNone", "{plugin: face_pose/three_point}",
     "{plugin: face_pose/three_point, in: {landmarks: left image}}",
     "deployment.yaml:10:57: the topic of input 'landmarks': 'left image' names no topic: words of "
     "letters, digits and _, not beginning with a digit, with / between them\n"},
    {"TopicsUnderNoTopic", "{plugin: face_pose/three_point}",
     "{plugin: face_pose/three_point, topics: left/}",
     "deployment.yaml:10:49: 'topics': 'left/' names no topic: words of letters, digits and _, not "
     "beginning with a digit, with / between them\n"},
    {"TopicsUnderAnotherName", "  target: {plugin: target/constant_velocity}",
     "  target: {plugin: target/constant_velocity, topics: left}",
     "deployment.yaml:11:3: target.face reads topic '/faulty/left/face', which nobody writes; did "
     "you mean '/faulty/face'?\n"
     "deployment.yaml:11:3: target.measured_js reads topic '/faulty/left/arm/measured_js', which "
     "nobody writes; did you mean '/faulty/arm/measured_js'?\n"
     "deployment.yaml:12:3: task.target reads topic '/faulty/target', which nobody writes; did you "
     "mean '/faulty/left/target'?\n"
     "deployment.yaml:21:3: report.target reads topic '/faulty/target', which nobody writes; did "
     "you mean '/faulty/left/target'?\n"},
    {"PortsThatAreNoMap", "{plugin: face_pose/three_point}",
     "{plugin: face_pose/three_point, in: [landmarks]}",
     "deployment.yaml:10:45: the inputs of component 'face' must be a map from ports to topics, "
     "not "
     "a list\n"},
    {"GoalOfNothing", "distance_error_mm: 1.5", "distance_error_mm: null",
     "deployment.yaml:22:28: 'distance_error_mm' must be a number, not nothing\n"},
    {"ListForMap", "goals: {distance_error_mm: 1.5}", "goals: [distance_error_mm]",
     "deployment.yaml:22:8: goals must be a map, not a list\n"},
    {"ComponentIsText", "  face: {plugin: face_pose/three_point}", "  face: face_pose/three_point",
     "deployment.yaml:10:9: component 'face' must be a map, not 'face_pose/three_point'\n"},
    {"DomainOutOfRange", "clock: simulated", "domain: 400",
     "deployment.yaml:3:9: 'domain' is 400, must be from 0 to 232\n"},
    {"SlotInAPurePlugin", "{plugin: face_pose/three_point}",
     "{plugin: face_pose/three_point, ik: {plugin: ik/numeric}}",
     "deployment.yaml:10:41: unknown key 'ik' in component 'face'; did you mean 'in'?\n"},
    {"TransportAsAComponent", "{plugin: face_pose/three_point}", "{plugin: transport/fast_dds}",
     "deployment.yaml:10:18: 'transport/fast_dds' is of kind 'transport', which is no component "
     "and has no host to run it alone\n"},
    {"CpuThatNoMachineHas", "period_s: 0.001", "period_s: 0.001, cpu: 9999",
     "deployment.yaml:6:45: 'cpu' is 9999, must be from 0 to 1023\n"},
    {"CpuThatIsNoNumber", "period_s: 0.001", "period_s: 0.001, cpu: all",
     "deployment.yaml:6:45: 'cpu' must be a whole number, not 'all'\n"},
    {"PriorityOutOfRange", "period_s: 0.001", "period_s: 0.001, priority: 100",
     "deployment.yaml:6:50: 'priority' is 100, must be from 0 to 99: 0 is normal\n"},
    {"PriorityBeyond32Bits", "period_s: 0.001", "period_s: 0.001, priority: 4294967346",
     "deployment.yaml:6:50: 'priority' is 4294967346, must be from 0 to 99: 0 is normal\n"},
    {"DomainBeyond32Bits", "executors:", "domain: 4294967296\nexecutors:",
     "deployment.yaml:6:9: 'domain' is 4294967296, must be from 0 to 232\n"},
    {"InterfacesThatAreNoList", "executors:", "dds: {interfaces: eth0}\nexecutors:",
     "deployment.yaml:6:19: 'interfaces' must be a list of names or IPv4 addresses, [eth0], not "
     "'eth0'\n"},
    {"InterfacesThatAreNoneAnywhere",
     "executors:", "dds: {interfaces: ['', [lo], fe80::1, 192.168.7.2/24]}\nexecutors:",
     "deployment.yaml:6:20: an interface has a name, or an IPv4 address\n"
     "deployment.yaml:6:24: 'interfaces' lists names or IPv4 addresses, not a list\n"
     "deployment.yaml:6:30: 'fe80::1' is an IPv6 address, and DDS joins IPv4 only; give its "
     "interface\n"
     "deployment.yaml:6:39: '192.168.7.2/24' is neither the name of an interface (at most 15 "
     "characters) nor an IPv4 address (192.168.7.2)\n"},
    {"PeersThatAreNone", "executors:", "dds: {peers: [theatre-2, 10.0.0, 'a b']}\nexecutors:",
     "deployment.yaml:6:26: '10.0.0' is neither the name of a host nor an IPv4 address "
     "(192.168.7.2)\n"
     "deployment.yaml:6:34: 'a b' is neither the name of a host nor an IPv4 address "
     "(192.168.7.2)\n"},
    {"DiscoveryServerAtNoPort", "executors:", "dds: {discovery_server: 'desk:99999'}\nexecutors:",
     "deployment.yaml:6:25: '99999' in 'desk:99999' is no port, from 1 to 65535\n"},
    {"DiscoveryServerBesidePeers",
     "executors:", "dds: {peers: [desk], discovery_server: desk}\nexecutors:",
     "deployment.yaml:6:40: 'peers' are asked without a discovery server; the file names both\n"},
    {"SharedMemoryThatIsNeitherOnNorOff", "executors:", "dds: {shared_memory: false}\nexecutors:",
     "deployment.yaml:6:22: 'shared_memory' cannot be 'false'; known: on, off\n"},
    {"HostOnTheSimulatedClock", "executor: control}", "executor: control, host: desk}",
     "deployment.yaml:20:57: the simulated clock runs on one host; remove 'host' or set 'clock: "
     "system'\n"},
    {"HostWithANameThatIsNone", "executor: control}", "executor: control, host: theatre-2}",
     "deployment.yaml:20:57: 'theatre-2' must consist of letters, digits and '_', and begin with "
     "no "
     "digit\n"},
    {"UnknownKeyOfDds", "executors:", "dds: {interface: [lo]}\nexecutors:",
     "deployment.yaml:6:7: unknown key 'interface' in dds; did you mean 'interfaces'?\n"},
    {"OpenedInputThatIsMistyped", "executors:", "open: [report.measurd_js]\nexecutors:",
     "deployment.yaml:6:8: no component has the input 'report.measurd_js'; did you mean "
     "'report.measured_js'?\n"},
    {"OpenedCommands", "executors:", "open: [motion.goal]\nexecutors:",
     "deployment.yaml:6:8: 'motion.goal' takes commands, which come from the deployment itself "
     "only; open an input of a component that decides, and let that one command\n"},
    {"OpenThatIsNoList", "executors:", "open: motion.goal\nexecutors:",
     "deployment.yaml:6:7: 'open' must be a list of inputs, [task.target], not 'motion.goal'\n"},
    {"NegativeLatency", "{plugin: face_pose/three_point}",
     "{plugin: face_pose/three_point, sim_latency_s: -0.1}",
     "deployment.yaml:10:56: 'sim_latency_s' is -0.1, must be from 0 to 3600\n"},
    {"EndlessLatency", "{plugin: face_pose/three_point}",
     "{plugin: face_pose/three_point, sim_latency_s: 1e300}",
     "deployment.yaml:10:56: 'sim_latency_s' is 1e+300, must be from 0 to 3600\n"},
    {"TimeLawThatNobodyKeeps",
     "path: {plugin: path/mouth_arc}\n"
     "    ik: {plugin: ik/lamp_geometric}\n"
     "    select: {plugin: select/nearest}\n"
     "    trajectory: {plugin: trajectory/quintic_spline}",
     "path: {plugin: path/mouth_points}\n"
     "    ik: {plugin: ik/lamp_geometric}\n"
     "    select: {plugin: select/nearest}\n"
     "    trajectory: {plugin: trajectory/hasty}",
     "deployment.yaml:16:20: 'path/mouth_points' requires 'time_law' unless 'segment_s' is 0, and "
     "nothing in component 'motion' provides it; provided by trajectory/cubic_spline, "
     "trajectory/quintic, trajectory/quintic_spline, trajectory/sampled\n"},
    {"NeedThatNoPluginKnows", "path: {plugin: path/mouth_arc}", "path: {plugin: path/mistyped}",
     "deployment.yaml:16:20: 'path/mistyped' requires 'time_lwa', and nothing in component "
     "'motion' "
     "provides it; no plugin on the search path does; did you mean 'time_law'?\n"},
    {"MoveThatNeverComes", "{plugin: report/lamp_alignment}",
     "{plugin: report/lamp_alignment, params: {expect_move: true}}",
     "deployment.yaml:21:3: 'report' requires 'patient_moves' unless 'expect_move' is false, and "
     "no "
     "component on its topics provides it; 'scene' does unless 'move_duration_s' is 0\n"},
    {"MoveOfNothing", "tilt_up_deg: 0", "move_duration_s: 2",
     "deployment.yaml:8:3: component 'scene': move_duration_s is set but nothing moves; set "
     "move_mm, move_tilt_up_deg or move_tilt_side_deg, or move_duration_s to 0\n"},
    {"StandstillThatTheDriverDoesNotWaitFor", "arm/simulated, executor: control",
     "arm/simulated, executor: control, params: {command_timeout_s: 0.05}",
     "deployment.yaml:20:79: 'max_lateness_s' of component 'motion' is 0.1 (its default), above "
     "'command_timeout_s' of component 'arm', which is 0.05 (deployment.yaml:20:79); lower the "
     "first or raise the second\n"},
    {"StandstillThatIsTooLong", "max_velocity_rad_s: 1.0", "max_lateness_s: 0.2",
     "deployment.yaml:15:30: 'max_lateness_s' of component 'motion' is 0.2 "
     "(deployment.yaml:15:30), above 'command_timeout_s' of component 'arm', which is 0.1 (its "
     "default); lower the first or raise the second\n"},
    {"GoalThatNothingMeets", "distance_error_mm: 1.5", "distance_error_mm: -1",
     "deployment.yaml:22:28: the goal -1 cannot be met: 'distance_error_mm' is never below 0\n"},
    {"GoalForAMetricThatIsMistyped", "distance_error_mm: 1.5", "distance_eror_mm: 1.5",
     "deployment.yaml:22:9: no component measures 'distance_eror_mm'; did you mean "
     "'distance_error_mm'?\n"},
    {"GoalThatNobodyMeasures", "  report: {plugin: report/lamp_alignment}\n", "",
     "deployment.yaml:21:9: no component measures 'distance_error_mm'; measured by "
     "report/lamp_alignment\n"},
};

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << "base.yaml has no '" << from << "'";
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

std::string without(std::string text, const std::string& part) {
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part)) {
    text.erase(at, part.size());
  }
  return text;
}

class FaultyDeployment : public testing::TestWithParam<Fault> {
 public:
  using Change = std::pair<std::string, std::string>;  // this text becomes that

 protected:
  /// What `verb` says of the base with these changes.
  CommandResult check(const std::vector<Change>& changes, const char* verb = "check") const {
    std::string text = content_of(source_file("tests/faults/base.yaml"));
    for (const auto& [from, to] : changes) text = replaced(text, from, to);
    for (const std::string mark = "@CONFIGS@"; text.find(mark) != std::string::npos;) {
      text = replaced(text, mark, source_file("configs"));
    }
    const fs::path file = folder_ / "deployment.yaml";
    std::ofstream{file} << text;
    CommandResult result =
        run_command({armature(), verb, file.string()},
                    {.environment = {{"ARMATURE_PLUGIN_PATH", FAULT_PLUGINS}}, .input = {}});
    result.err =
        without(without(result.err, folder_.path().string() + "/"), source_file("configs/"));
    result.err = without(result.err, "; searched " FAULT_PLUGINS ", " ARMATURE_PLUGIN_BUILD_DIR);
    return result;
  }

 private:
  const TemporaryFolder folder_;
};

TEST_P(FaultyDeployment, IsRefusedWithItsExactMessage) {
  const auto result = check({{GetParam().from, GetParam().to}});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_EQ(result.err, GetParam().messages);
  EXPECT_EQ(result.out, "");
}

INSTANTIATE_TEST_SUITE_P(Faults, FaultyDeployment, testing::ValuesIn(kFaults),
                         [](const auto& test) { return std::string{test.param.name}; });

using SoundDeployment = FaultyDeployment;

TEST_F(SoundDeployment, PassesTheCheck) {
  const auto result = check({{"name: faulty", "name: sound"}});
  EXPECT_EQ(result.exit_code, 0) << result.err;
}

TEST_F(SoundDeployment, AProcessorOfALargerMachinePassesTheCheck) {
  const auto result = check({{"period_s: 0.001", "period_s: 0.001, cpu: 1023"}});
  EXPECT_EQ(result.exit_code, 0) << result.err;
}

TEST_F(SoundDeployment, EverySeedOf64BitsPassesTheCheck) {
  for (const std::string seed : {"0", "9223372036854775808", "18446744073709551615"}) {
    const auto result = check({{"clock: simulated", "seed: " + seed}});
    EXPECT_EQ(result.exit_code, 0) << seed << ": " << result.err;
  }
}

TEST_F(SoundDeployment, ATimeLawThatIsKeptOrNotUsedPassesTheCheck) {
  const Change points{"path/mouth_arc}", "path/mouth_points}"};
  const Change idle_points{"path/mouth_arc}", "path/mouth_points, params: {segment_s: 0}}"};
  const Change hasty{"trajectory/quintic_spline", "trajectory/hasty"};
  for (const auto& changes : std::vector<std::vector<Change>>{{points}, {idle_points, hasty}}) {
    const auto result = check(changes);
    EXPECT_EQ(result.exit_code, 0) << result.err;
  }
}

TEST_F(SoundDeployment, APathThatRunsAloneNeedsNobody) {
  const auto result =
      check({{"components:\n", "components:\n  alone: {plugin: path/mouth_points}\n"}});
  EXPECT_EQ(result.exit_code, 0) << result.err;
}

TEST_F(SoundDeployment, AMoveThatComesPassesTheCheck) {
  const auto result = check({{"{plugin: report/lamp_alignment}",
                              "{plugin: report/lamp_alignment, params: {expect_move: true}}"},
                             {"tilt_up_deg: 0", "move_duration_s: 2, move_mm: [0, 10, 0]"}});
  EXPECT_EQ(result.exit_code, 0) << result.err;
}

TEST_F(SoundDeployment, AnInterfaceOfAnotherMachinePassesTheCheckAndNotTheRun) {
  const Change elsewhere{"executors:", "dds: {interfaces: [lo, elsewhere0]}\nexecutors:"};
  const auto checked = check({elsewhere});
  EXPECT_EQ(checked.exit_code, 0) << checked.err;
  const auto shown = check({elsewhere}, "show");
  EXPECT_NE(shown.out.find("interfaces: [lo, elsewhere0]"), std::string::npos) << shown.out;
  const auto run = check({elsewhere}, "run");
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_TRUE(
      run.err.starts_with("deployment.yaml:6:24: there is no interface 'elsewhere0'; this "
                          "machine has lo (127.0.0.1)"))
      << run.err;
}

const FaultyDeployment::Change kSystemClock{"clock: simulated", "clock: system"};

TEST_F(SoundDeployment, AProgramThatAParameterNamesIsNotRunByTheCheck) {
  const TemporaryFolder folder;
  const fs::path trace = folder / "program_ran";
  const auto result =
      check({kSystemClock,
             {"plugin: ik/lamp_geometric",
              "plugin: ik/process, params: {command: [touch, " + trace.string() + "]}"}});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(
      result.out.starts_with("not tried: component 'motion', as ik/process runs a program\n"))
      << result.out;
  EXPECT_FALSE(fs::exists(trace)) << "it ran";
}

using SplitDeployment = FaultyDeployment;

TEST_F(SplitDeployment, AProcessHasAName) {
  for (const std::string name : {"../x", "-v", "a b"}) {
    const auto result = check({kSystemClock,
                               {"{plugin: face_pose/three_point}",
                                "{plugin: face_pose/three_point, process: '" + name + "'}"}});
    EXPECT_EQ(result.exit_code, 3);
    EXPECT_EQ(result.err, "deployment.yaml:10:50: '" + name +
                              "' must consist of letters, digits and '_', and begin with no "
                              "digit\n");
  }
}

TEST_F(SplitDeployment, ATopicThatIsTooLongForDdsIsRefusedAtItsPlace) {
  const auto result =
      check({{"{plugin: face_pose/three_point}",
              "{plugin: face_pose/three_point, topics: " + std::string(250, 'f') + "}"}});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_NE(result.err.find("deployment.yaml:10:3: the topic of output 'face' has 263 letters, and "
                            "DDS takes at most 240: shorten the deployment's name, 'topics' or the "
                            "topic\n"),
            std::string::npos)
      << result.err;
}

TEST_F(SplitDeployment, AnIkProgramThatDoesNotKnowTheRobotIsRefusedWithItsAnswer) {
  const std::string command = armature() + ", ik, --robot, @CONFIGS@/robots/sr1.yaml";
  const auto result = check(
      {kSystemClock,
       {"plugin: ik/lamp_geometric", "plugin: ik/process, params: {command: [" + command + "]}"}},
      "run");
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_NE(result.err.find("\ndeployment.yaml:17:18: slot 'ik' of component 'motion': ik/process "
                            "refuses: the program '"),
            std::string::npos)
      << result.err;
  EXPECT_TRUE(
      result.err.ends_with("' does not accept the robot's resting position as a goal: the "
                           "robot file names no 'pointing_axis'; give 'quaternion_xyzw'\n"))
      << result.err;
}

TEST_F(SplitDeployment, FiguresThatNobodyWouldShowAreRefused) {
  const auto result = check(
      {{"clock: simulated", "clock: system"},
       {"{plugin: report/lamp_alignment}", "{plugin: report/lamp_alignment, process: aside}"}});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_EQ(result.err,
            "deployment.yaml:21:52: 'report/lamp_alignment' tells figures of the run, which only "
            "the process 'main' shows; remove 'process' from 'report'\n");
}

}  // namespace
}  // namespace armature::test
