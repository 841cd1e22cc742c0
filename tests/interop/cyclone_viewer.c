/* SPDX-License-Identifier: Apache-2.0 */
/* Another vendor's DDS does what a viewer does: it builds the tree of frames from /tf and /tf_static,
 * and reads the markers of one robot. Prints, until SECONDS are over,
 *   tf SEC NANOSEC x y z qx qy qz qw             PARENT_T_CHILD after every /tf message
 *   marker NS ID TYPE ACTION FRAME POINTS        every marker
 *   cyclone_viewer DOMAIN MARKER_TOPIC PARENT CHILD SECONDS */
#include <stdio.h>
#include <string.h>

#include "cyclone_reader.h"
#include "tf2_msgs.h"
#include "visualization_msgs.h"

typedef geometry_msgs_msg_dds__Vector3_ vector3;
typedef geometry_msgs_msg_dds__Quaternion_ quaternion;
typedef geometry_msgs_msg_dds__Transform_ transform;

enum { MOST_FRAMES = 64, NAME = 64 };

static struct {
  char parent[NAME], child[NAME];
  transform parent_T_child;
} edges[MOST_FRAMES];
static int edge_count = 0;

static const char *from = "", *to = "";

static int find_edge(const char *child) {
  for (int i = 0; i < edge_count; ++i) {
    if (strcmp(edges[i].child, child) == 0) return i;
  }
  return -1;
}

static void keep(const geometry_msgs_msg_dds__TransformStamped_ *stamped) {
  int i = find_edge(stamped->child_frame_id_);
  if (i < 0) {
    if (edge_count == MOST_FRAMES) return;
    i = edge_count++;
  }
  snprintf(edges[i].parent, NAME, "%s", stamped->header_.frame_id_);
  snprintf(edges[i].child, NAME, "%s", stamped->child_frame_id_);
  edges[i].parent_T_child = stamped->transform_;
}

static vector3 cross(vector3 a, vector3 b) {
  const vector3 c = {a.y_ * b.z_ - a.z_ * b.y_, a.z_ * b.x_ - a.x_ * b.z_, a.x_ * b.y_ - a.y_ * b.x_};
  return c;
}

/* v + 2 w (u x v) + 2 u x (u x v), u the quaternion's vector part */
static vector3 turned(quaternion q, vector3 v) {
  const vector3 u = {q.x_, q.y_, q.z_};
  const vector3 uv = cross(u, v), uuv = cross(u, uv);
  const vector3 result = {v.x_ + 2 * (q.w_ * uv.x_ + uuv.x_), v.y_ + 2 * (q.w_ * uv.y_ + uuv.y_),
                          v.z_ + 2 * (q.w_ * uv.z_ + uuv.z_)};
  return result;
}

static quaternion product(quaternion a, quaternion b) {
  const quaternion c = {a.w_ * b.x_ + a.x_ * b.w_ + a.y_ * b.z_ - a.z_ * b.y_,
                        a.w_ * b.y_ - a.x_ * b.z_ + a.y_ * b.w_ + a.z_ * b.x_,
                        a.w_ * b.z_ + a.x_ * b.y_ - a.y_ * b.x_ + a.z_ * b.w_,
                        a.w_ * b.w_ - a.x_ * b.x_ - a.y_ * b.y_ - a.z_ * b.z_};
  return c;
}

/* Climbs from CHILD to PARENT; false when an edge is not known yet. */
static bool look_up(transform *way) {
  const transform identity = {{0, 0, 0}, {0, 0, 0, 1}};
  *way = identity;
  const char *at = to;
  for (int steps = 0; strcmp(at, from) != 0; ++steps) {
    const int i = find_edge(at);
    if (i < 0 || steps == MOST_FRAMES) return false;
    const transform *edge = &edges[i].parent_T_child;
    const vector3 moved = turned(edge->rotation_, way->translation_);
    way->translation_.x_ = edge->translation_.x_ + moved.x_;
    way->translation_.y_ = edge->translation_.y_ + moved.y_;
    way->translation_.z_ = edge->translation_.z_ + moved.z_;
    way->rotation_ = product(edge->rotation_, way->rotation_);
    at = edges[i].parent;
  }
  return true;
}

static void see_fixed(const void *sample) {
  const tf2_msgs_msg_dds__TFMessage_ *message = sample;
  for (uint32_t i = 0; i < message->transforms_._length; ++i) keep(&message->transforms_._buffer[i]);
}

static void see_moving(const void *sample) {
  const tf2_msgs_msg_dds__TFMessage_ *message = sample;
  see_fixed(sample);
  transform way;
  if (message->transforms_._length == 0 || !look_up(&way)) return;
  const builtin_interfaces_msg_dds__Time_ stamp = message->transforms_._buffer[0].header_.stamp_;
  printf("tf %d %u %.17g %.17g %.17g %.17g %.17g %.17g %.17g\n", stamp.sec_, stamp.nanosec_,
         way.translation_.x_, way.translation_.y_, way.translation_.z_, way.rotation_.x_,
         way.rotation_.y_, way.rotation_.z_, way.rotation_.w_);
  fflush(stdout);
}

static void see_markers(const void *sample) {
  const visualization_msgs_msg_dds__MarkerArray_ *array = sample;
  for (uint32_t i = 0; i < array->markers_._length; ++i) {
    const visualization_msgs_msg_dds__Marker_ *marker = &array->markers_._buffer[i];
    printf("marker %s %d %d %d %s %u\n", marker->ns_, marker->id_, marker->type_, marker->action_,
           marker->header_.frame_id_, marker->points_._length);
  }
  fflush(stdout);
}

int main(int argc, char **argv) {
  if (argc != 6) {
    fprintf(stderr, "usage: cyclone_viewer DOMAIN MARKER_TOPIC PARENT CHILD SECONDS\n");
    return 2;
  }
  from = argv[3];
  to = argv[4];
  const dds_entity_t participant = join_domain(argv[1]);
  const dds_entity_t fixed =
      make_reader(participant, &tf2_msgs_msg_dds__TFMessage__desc, "rt/tf_static", true);
  const dds_entity_t moving =
      make_reader(participant, &tf2_msgs_msg_dds__TFMessage__desc, "rt/tf", false);
  const dds_entity_t markers = make_reader(
      participant, &visualization_msgs_msg_dds__MarkerArray__desc, argv[2], false);
  if (fixed < 0 || moving < 0 || markers < 0) {
    fprintf(stderr, "cyclone_viewer: cannot make its readers\n");
    return 2;
  }
  const dds_time_t deadline = dds_time() + DDS_SECS(atoi(argv[5]));
  while (dds_time() < deadline) {
    const bool any = take_one(fixed, see_fixed) | take_one(moving, see_moving) |
                     take_one(markers, see_markers);
    if (!any) dds_sleepfor(DDS_MSECS(5));
  }
  dds_delete(DDS_CYCLONEDDS_HANDLE);
  return 0;
}
