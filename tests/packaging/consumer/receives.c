/* The LCM types in C: a message there and back. */
#include <roundel/roundel_pose_t.h>
#include <stdlib.h>

int main(void) {
  roundel_pose_t pose = {0}, received;
  int size, status;
  char* bytes;
  pose.marker.id = 7;
  size = roundel_pose_t_encoded_size(&pose);
  bytes = malloc(size);
  status = roundel_pose_t_encode(bytes, 0, size, &pose) != size ||
           roundel_pose_t_decode(bytes, 0, size, &received) != size || received.marker.id != 7;
  free(bytes);
  return status;
}
