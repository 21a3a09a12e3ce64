// Foxglove's messages, decoded by the schemas that come with them.
import protobuf from "protobufjs";
import "protobufjs/ext/descriptor/index.js";
import descriptor from "protobufjs/ext/descriptor/index.js";

/** Fails with the claim unless it holds. */
export function check(claim, holds, what = "") {
  if (!holds) throw new Error(`FAILED: ${claim} ${what}`);
  console.log(`ok: ${claim}`);
}

/** A function that decodes messages of the type; `schema`: a serialised FileDescriptorSet. */
export function decoder(name, schema) {
  const root = protobuf.Root.fromDescriptor(descriptor.FileDescriptorSet.decode(schema));
  const type = root.lookupType(name);
  return (bytes) => type.toObject(type.decode(bytes), { longs: Number, arrays: true, defaults: true });
}

/** How many points a foxglove.PointCloud has; fails unless its bytes are whole points. */
export function points_in(cloud) {
  const points = cloud.data.length / cloud.point_stride;
  if (!Number.isInteger(points)) throw new Error("FAILED: a point is not whole");
  return points;
}

/** The topics of the scene (tests/foreign/scene.h). */
export const topics = ["/candidate_points", "/candidates", "/cloud", "/cloud_slice", "/free_space", "/grid/low", "/health",
  "/localisation", "/map", "/moving_obstacles", "/obstacles", "/odometry", "/path", "/pose", "/scan/low", "/scan_far/low", "/tf", "/traversability/low", "/truth"];
