// Decoders by the definitions that go with the data, of others' make.
import { parseIDL } from "@foxglove/omgidl-parser";
import { MessageReader as IdlReader } from "@foxglove/omgidl-serialization";
import { parse as parseRosMessage } from "@foxglove/rosmsg";
import { MessageReader as RosReader } from "@foxglove/rosmsg2-serialization";

const readers = {
  omgidl: (name, text) => new IdlReader(name, parseIDL(text)),
  ros2msg: (_, text) => new RosReader(parseRosMessage(text, { ros2: true })),
};

export const decoderOf = (encoding, name, text) => readers[encoding](name, text);
