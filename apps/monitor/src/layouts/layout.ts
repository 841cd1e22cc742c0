// SPDX-License-Identifier: Apache-2.0
// What is shown of a deployment. The shipped ones have files of their own; of any other it is found
// in its topics.
import type {Deployment} from '../deployment';
import type {Hub} from '../hub';
import {numericFields} from '../message/fields';
import dentalImplant from './dental_implant.json';
import dentalLamp from './dental_lamp.json';
import masterManipulator from './master_manipulator.json';
import sr1Biopsy from './sr1_biopsy.json';
import sr1Images from './sr1_from_images.json';

export interface Series {
  label: string;
  value: string;        // an expression
  goal?: string;        // of the deployment file: at most
  headline?: boolean;   // it stands in the head, too
  digits?: number;
}
export interface PlotLayout {
  title: string;
  unit: string;
  log?: boolean;
  min?: number;  // of a logarithmic axis
  max?: number;
  series: Series[];
}
export interface Tool {
  frame: string;
  kind: 'lamp' | 'needle' | 'drill' | 'shaft';
  length?: number;   // [m] behind the tip
  instead?: string;  // the link of the arm that it is: its own drawing tells nothing of it
}
export interface ImageLayout {
  title: string;
  image: string;       // raw; the compressed one is found beside it
  side?: 'left' | 'right';  // of landmarks
}
export interface Layout {
  deployment: string;
  title?: string;
  story: string;
  scene: {
    eye?: number[];    // where it is looked from [m]
    target?: number[];
    trails: {topic: string; label: string; colour: string}[];
    tools: Tool[];
    frames: string[];  // topics with transforms, beside /tf
    bodies: {topic: string; label: string}[];
    face?: string;
    labels?: {at: string; text: string}[];  // at a frame, or at a marker: namespace/id
    closeUp?: {frame: string; distance: number; from: number[]};  // a second look, at a tip [m]
    trailS?: number;     // how far back the ways are drawn [s]
    hide?: string[];     // markers that something else shows better: namespace, or namespace/id
  };
  images: ImageLayout[];
  plots: PlotLayout[];
}

const kShipped = [dentalLamp, sr1Biopsy, sr1Images, dentalImplant, masterManipulator] as unknown as Layout[];

export function shippedLayout(name: string): Layout | undefined {
  return kShipped.find((layout) => layout.deployment === name);
}

export const kEmpty: Layout = {
  deployment: '',
  story: '',
  scene: {trails: [], tools: [], frames: [], bodies: []},
  images: [],
  plots: [],
};

/// Of a deployment that is not known: its arms, its cameras, the joints of each arm.
export function derivedLayout(hub: Hub, deployment: Deployment | undefined): Layout {
  const inNamespace = (topic: string) =>
      deployment && topic.startsWith(`${deployment.namespace}/`) ? topic.slice(deployment.namespace.length + 1) : topic;
  const colours = ['#56b4e9', '#e69f00', '#009e73', '#cc79a7'];
  const trails = hub.ofType('geometry_msgs/msg/PoseStamped').filter((topic) => topic.endsWith('/tool_pose'));
  const jpegs = hub.ofType('sensor_msgs/msg/CompressedImage').map((topic) => topic.replace(/\/compressed$/, ''));
  const images = [...new Set([...hub.ofType('sensor_msgs/msg/Image'), ...jpegs])].slice(0, 2);
  const joints = hub.ofType('sensor_msgs/msg/JointState').filter((topic) => topic.endsWith('/joint_states') || topic === '/joint_states');
  const measured = hub.ofType('sensor_msgs/msg/JointState').filter((topic) => topic.endsWith('/measured_js'));
  return {
    ...kEmpty,
    deployment: deployment?.name ?? '',
    story: deployment ? 'No layout was made for this deployment: this one was found in its topics' : '',
    scene: {
      ...kEmpty.scene,
      trails: trails.slice(0, 4).map((topic, i) => ({topic: inNamespace(topic), label: inNamespace(topic), colour: colours[i]!})),
    },
    images: images.map((image) => ({title: inNamespace(image).replace(/\/image_raw$/, ''), image: inNamespace(image)})),
    plots: (joints.length > 0 ? joints : measured).slice(0, 2).map((topic) => ({
      title: `Joints, ${inNamespace(topic)}`,
      unit: 'rad or m',
      series: jointFields(hub, topic).map((field) => ({label: field, value: `{${inNamespace(topic)}}.${field}`})),
    })),
  };
}

function jointFields(hub: Hub, topic: string): string[] {
  const log = hub.log(topic), message = log.message(log.last);
  if (!message) return Array.from({length: 6}, (_, i) => `position[${i}]`);
  return numericFields(message).filter((field) => field.startsWith('position')).slice(0, 8);
}
