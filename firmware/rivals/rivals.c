/* What a firmware engineer would write instead of octruss, in C: the rivals of `cargo xtask bench`.
   Compiled with arm-none-eabi-gcc -O3, the floating-point unit on, multiplications and additions fused. */

#include <stdint.h>

typedef float point_t[3];

/* Compressed sparse rows in floating point. */
void rival_csr(const uint32_t *restrict starts, const uint16_t *restrict indices,
               const float *restrict weights, const point_t *restrict pose,
               point_t *restrict out, uint32_t rows)
{
    for (uint32_t row = 0; row < rows; row++) {
        float x = 0, y = 0, z = 0;
        for (uint32_t tap = starts[row]; tap < starts[row + 1]; tap++) {
            const float *point = pose[indices[tap]];
            float weight = weights[tap];
            x += weight * point[0];
            y += weight * point[1];
            z += weight * point[2];
        }
        out[row][0] = x;
        out[row][1] = y;
        out[row][2] = z;
    }
}

/* The same loop on octruss's groups: control points are gathered once a group. */
void rival_grouped(const uint16_t *restrict groups, uint32_t count,
                   const uint16_t *restrict indices, const float *restrict weights,
                   const point_t *restrict pose, point_t *restrict out)
{
    point_t points[64];
    for (uint32_t group = 0; group < count; group++) {
        uint32_t rows = groups[2 * group], taps = groups[2 * group + 1];
        for (uint32_t tap = 0; tap < taps; tap++) {
            const float *point = pose[*indices++];
            points[tap][0] = point[0];
            points[tap][1] = point[1];
            points[tap][2] = point[2];
        }
        for (uint32_t row = 0; row < rows; row++) {
            float x = 0, y = 0, z = 0;
            for (uint32_t tap = 0; tap < taps; tap++) {
                float weight = *weights++;
                x += weight * points[tap][0];
                y += weight * points[tap][1];
                z += weight * points[tap][2];
            }
            (*out)[0] = x;
            (*out)[1] = y;
            (*out)[2] = z;
            out++;
        }
    }
}

/* A product of dense matrices in Q31 with 64-bit sums, as CMSIS-DSP's arm_mat_mult_q31 forms it. */
void rival_dense_q31(const int32_t *restrict weights, const int32_t *restrict pose,
                     int32_t *restrict out, uint32_t rows, uint32_t points)
{
    for (uint32_t row = 0; row < rows; row++) {
        for (uint32_t column = 0; column < 3; column++) {
            const int32_t *a = weights + row * points, *b = pose + column;
            int64_t sum = 0;
            for (uint32_t point = 0; point < points; point++, b += 3) {
                sum += (int64_t)*a++ * *b;
            }
            *out++ = (int32_t)(sum >> 31);
        }
    }
}
