// SPDX-License-Identifier: Apache-2.0
// What a running deployment tells of itself: its components with parameters and ports, how they
// are, what its files say.
import type {Hub} from './hub';
import type {Message} from './message/decoder';

export const kStates = ['ok', 'degraded', 'fault', 'stalled'] as const;
const kSilentS = 5;  // a process that has told nothing for so long tells nothing any more: states come twice a second
const kStatesKept = 12;  // of a process: those that come in that time, and some

export interface Port {
  name: string;
  output: boolean;
  feedback: boolean;
  topic: string;
  type: string;
  qos: string;
  reliable: boolean;
  doc: string;
}
export interface Component {
  name: string;
  plugin: string;
  executor: string;
  process: string;
  plugins: {slot: string; plugin: string; abi: string; sha256: string; parameters: {name: string; value: string; origin: string}[]}[];
  ports: Port[];
}
export interface ComponentCondition {
  state: number;
  reason: string;
  hz: number;
  missed: number;
  dropped: number;
  stepP99: number;  // [s]
  latenessP99: number;
  reaction: {source: string; p99: number} | undefined;  // the slowest
}

export class Deployment {
  components: Component[] = [];
  configuration = '';
  run = '';
  version = '';
  fingerprint = '';
  processes: string[] = [];
  told: string[] = [];  // processes that have told of themselves
  documents: {section: string; name: string; text: string}[] = [];
  private seen = -1;
  private shared = new Set<string>();  // names of components that several processes have: the runtime's own

  constructor(private readonly hub: Hub, readonly name: string, readonly namespace: string) {}

  get descriptionTopic() { return `${this.namespace}/description`; }
  get statesTopic() { return `${this.namespace}/component_states`; }
  /// A topic as layouts name it: "tool_pose" stands in the namespace, "/tf" does not.
  topic(name: string) { return name.startsWith('/') ? name : `${this.namespace}/${name}`; }

  /// Reads again what has come since; true: something has changed.
  update(): boolean {
    const log = this.hub.log(this.descriptionTopic);
    if (log.version === this.seen) return false;
    this.seen = log.version;
    const newest: Message | undefined = log.message(log.last);
    if (!newest) return false;
    const byProcess = new Map<string, Message>();
    for (let i = 0; i < log.length; ++i) {
      const message = log.message(log.entry(i));
      if (message?.run === newest.run) byProcess.set(message.process, message);
    }
    this.run = newest.run;
    this.version = newest.version;
    this.fingerprint = newest.fingerprint;
    this.processes = newest.processes;
    this.told = [...byProcess.keys()];
    this.configuration = newest.configuration;
    this.documents = newest.documents;
    const all = [...byProcess.values()].flatMap(
        (message) => message.components.map((one: Component) => ({...one, process: message.process as string})));
    const names = all.map(({name}) => name);
    this.shared = new Set(names.filter((name, i) => names.indexOf(name) !== i));
    this.components = all.map((one) => ({...one, name: this.nameOf(one.name, one.process)}));
    return true;
  }
  /// What a component is called here: 'runtime@vision' where the main process has one of that name, too.
  private nameOf(component: string, process: string): string {
    return this.shared.has(component) && process !== 'main' ? `${component}@${process}` : component;
  }

  /// How the components were at a time, from the newest message of each process.
  conditionsAt(t: number): Map<string, ComponentCondition> {
    const found = new Map<string, ComponentCondition>();
    for (const [process, {i, t: toldAt, message}] of this.statesAt(t)) {
      const previous = this.previous(i, process);
      for (const one of message.components) {
        const before = previous?.message.components.find((other: Message) => other.component === one.component);
        const activations = before ? Number(one.activations) - Number(before.activations) : NaN;
        const reactions = [...one.reactions].sort((a: Message, b: Message) => b.age.p99 - a.age.p99);
        found.set(this.nameOf(one.component, process), {
          state: one.state,
          reason: one.reason,
          hz: previous ? activations / (toldAt - previous.t) : NaN,
          missed: Number(one.overruns),
          dropped: Number(one.dropped),
          stepP99: one.step.p99,
          latenessP99: one.lateness.p99,
          reaction: reactions[0] ? {source: reactions[0].source, p99: reactions[0].age.p99} : undefined,
        });
      }
    }
    return found;
  }
  /// The processes that have told of themselves and tell nothing any more at a time: they have died, or stand still.
  silentAt(t: number): string[] {
    const first = this.hub.log(this.statesTopic).first?.t ?? NaN;
    if (!(t - first >= kSilentS)) return [];
    const heard = this.statesAt(t);
    return this.told.filter((process) => !heard.has(process));
  }
  /// How all of it was at a time, in a line, and the worst state in that.
  healthAt(t: number): {state: number; text: string} {
    const newest = this.hub.log(this.statesTopic).last?.t ?? NaN;
    if (t - newest > 3) return {state: 1, text: `nothing told of the components for ${(t - newest).toFixed(0)} s`};
    const conditions = this.conditionsAt(t);
    const bad = [...conditions].filter(([, one]) => one.state !== 0);
    const untold = this.processes.filter((process) => !this.told.includes(process)), silent = this.silentAt(t);
    let text = `${conditions.size - bad.length} of ${this.components.length} ok`;
    if (bad[0]) text += `; ${bad[0][0]} ${kStates[bad[0][1].state] ?? '?'}: ${bad[0][1].reason}`;
    if (untold.length > 0) text += `; ${untold.join(', ')} has told nothing`;
    if (silent.length > 0) text += `; ${silent.join(', ')} tells nothing any more`;
    return {state: Math.max(silent.length > 0 ? 2 : untold.length > 0 ? 1 : 0, ...bad.map(([, one]) => one.state)), text};
  }
  /// The newest states that each process has told until a time.
  private statesAt(t: number): Map<string, {i: number; t: number; message: Message}> {
    const log = this.hub.log(this.statesTopic);
    const found = new Map<string, {i: number; t: number; message: Message}>();
    for (let i = log.indexAt(t), steps = 0; i >= 0 && steps < kStatesKept * Math.max(1, this.processes.length); --i, ++steps) {
      const entry = log.entry(i)!;
      if (entry.t < t - kSilentS && found.size > 0) break;
      const message = log.message(entry);
      if (message && !found.has(message.process)) found.set(message.process, {i, t: entry.t, message});
    }
    return found;
  }
  private previous(i: number, process: string): {t: number; message: Message} | undefined {
    const log = this.hub.log(this.statesTopic);
    for (let j = i - 1; j >= 0 && j >= i - 8; --j) {
      const message = log.message(log.entry(j));
      if (message?.process === process) return {t: log.entry(j)!.t, message};
    }
    return undefined;
  }

  /// A number that a component was told; NaN: it has no such parameter.
  parameter(component: string, name: string): number {
    const [own] = this.components.find((one) => one.name === component)?.plugins ?? [];
    return Number(own?.parameters.find((one) => one.name === name)?.value ?? NaN);
  }

  /// The limits that the deployment file sets: `goals:` of its YAML.
  goals(): Map<string, number> {
    const goals = new Map<string, number>();
    const part = /^goals:[^\n]*\n((?:[ \t]+[^\n]*\n?|#[^\n]*\n)*)/m.exec(this.configuration)?.[1] ?? '';
    for (const [, name, value] of part.matchAll(/^\s+(\w+):\s*(-?[\d.eE+-]+)/gm)) goals.set(name!, Number(value));
    return goals;
  }
}

/// All deployments that the topics tell of, by name.
export function deploymentsOf(hub: Hub): {name: string; namespace: string}[] {
  return hub.ofType('armature_msgs/msg/DeploymentDescription').map((topic) => {
    const namespace = topic.replace(/\/description$/, '');
    return {name: namespace.replace(/^\//, ''), namespace};
  });
}
