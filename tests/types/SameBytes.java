import java.io.*;
import java.util.*;
import lcm.lcm.LCMEncodable;

/** Reads golden_messages' lines from standard input: Java decodes each message and encodes the same bytes. */
public class SameBytes {
  public static void main(String[] arguments) throws Exception {
    BufferedReader lines = new BufferedReader(new InputStreamReader(System.in));
    Set<String> seen = new TreeSet<>();
    for (String line = lines.readLine(); line != null; line = lines.readLine()) {
      String[] words = line.split(" ");
      byte[] data = HexFormat.of().parseHex(words[1]);
      byte[] again = encode(decode(words[0], data));
      if (!Arrays.equals(data, again)) {
        throw new AssertionError(words[0] + "\nread  " + words[1] + "\nwrote " + HexFormat.of().formatHex(again));
      }
      seen.add(words[0]);
    }
    System.out.println(seen.size() + " types");
  }

  static LCMEncodable decode(String type, byte[] data) throws Exception {
    return (LCMEncodable) Class.forName("voxlist." + type).getConstructor(byte[].class).newInstance(data);
  }

  static byte[] encode(LCMEncodable message) throws IOException {
    ByteArrayOutputStream bytes = new ByteArrayOutputStream();
    message.encode(new DataOutputStream(bytes));
    return bytes.toByteArray();
  }
}
