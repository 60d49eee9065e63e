/* The plain crank-slider as an expert writes it for this mechanism alone: massless crank, level guide through O, gravity,
   the coupler's centre on A-B. The library's formulas, simplified by hand: what the crank angles share is taken out of
   the loop, one division and one root are left in it, nothing guards them. With s and c of the coupler, k its rate and
   e its angular acceleration by crank angle, the point at the distance a from A on the coupler has the acceleration
   -(x + a p, y - a q) by crank angle. */

#define _GNU_SOURCE
#include <math.h>

typedef struct {
    double speed, crank, length, centre, coupler, inertia, slider, gravity;
} Design;

typedef struct {
    double crank, length, shorter, centre, coupler, inertia, slider, coupler_weight, slider_weight;
} Shared;

static inline Shared shared(const Design *d)
{
    double square = d->speed * d->speed;
    return (Shared){d->crank, d->length, 1.0 / d->length, d->centre, d->coupler * square, d->inertia * square,
                    d->slider * square, d->coupler * d->gravity, d->slider * d->gravity};
}

/* Rows of n values: O, A, B (x and y each), guide force, guide moment, torque. */
static inline __attribute__((always_inline)) void forces(Shared d, double sine, double cosine, double *restrict row, long n)
{
    double x = d.crank * cosine, y = d.crank * sine;
    double s = -y * d.shorter, c = sqrt((1.0 - s) * (1.0 + s));
    double over = 1.0 / c, k = x * d.shorter * over, k2 = k * k, e = (y - k2 * y) * d.shorter * over;
    double p = e * s + k2 * c, q = e * c - k2 * s;
    double load_x = d.coupler * (x + d.centre * p);
    double load_y = d.coupler * (y - d.centre * q) - d.coupler_weight;
    double moment = d.centre * (c * load_y - s * load_x) - d.inertia * e;
    double pin_x = -d.slider * (x + d.length * p);
    double pin_y = (moment * d.shorter + s * pin_x) * over;
    double inner_x = pin_x - load_x, inner_y = pin_y - load_y;
    row[0] = row[2 * n] = inner_x;
    row[n] = row[3 * n] = inner_y;
    row[4 * n] = pin_x;
    row[5 * n] = pin_y;
    row[6 * n] = d.slider_weight - pin_y;
    row[7 * n] = 0.0;
    row[8 * n] = x * inner_y - y * inner_x;
}

void turn(const Design *design, long n, const double *restrict angle, double *restrict out)
{
    Shared d = shared(design);
    for (long i = 0; i < n; i++) {
        double sine, cosine;
        sincos(angle[i], &sine, &cosine);
        forces(d, sine, cosine, out + i, n);
    }
}

void sweep(const Design *designs, long count, long n, const double *restrict sine, const double *restrict cosine,
           double *restrict out)
{
    for (long design = 0; design < count; design++) {
        Shared d = shared(designs + design);
#pragma GCC ivdep
        for (long i = 0; i < n; i++)
            forces(d, sine[i], cosine[i], out + 9 * n * design + i, n);
    }
}
