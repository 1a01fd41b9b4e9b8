# Pictures of what bench_speed measured.
#   gnuplot -e "folder='docs/results'" bench/speed/plots.gp
# Columns are taken by the names in the first line of speed.csv.

set datafile separator ','
set datafile columnheaders
set terminal svg size 900,420 background rgb 'white' font 'Helvetica,11'
set grid lc rgb '#dddddd'
set key left top samplen 2
set format y '%g'

# The lines of one scene and one kind of Roundel's frames.
rows(scene, frames) = sprintf( \
  "< awk -F, 'NR == 1 || ($1 == \"%s\" && $4 == \"roundel\" && $5 == \"%s\")' '%s/speed.csv'", \
  scene, frames, folder)
peer(system) = sprintf( \
  "< awk -F, 'NR == 1 || ($1 == \"floor\" && $4 == \"%s\")' '%s/speed.csv'", system, folder)
ms(c) = column(c) / 1000

set output sprintf('%s/growth-markers.svg', folder)
set title 'how cost grows with markers (medians)'
set logscale xy
set xlabel 'markers'
set ylabel 'ms a frame'
set xrange [0.8:1300]
set key outside right center
plot rows('crowd', 'following') using 'markers':(ms('median_us')) \
    with linespoints lw 1.5 pt 7 ps 0.6 lc rgb '#0060b0' title '4K, 20 px: following', \
  rows('crowd', 'first') using 'markers':(ms('median_us')) \
    with linespoints lw 1.5 pt 6 ps 0.6 lc rgb '#60a0e0' title 'first frame', \
  rows('floor', 'following') using 'markers':(ms('median_us')) \
    with linespoints lw 1.5 pt 5 ps 0.6 lc rgb '#308030' title 'Full HD, 41 px: following', \
  rows('floor', 'first') using 'markers':(ms('median_us')) \
    with linespoints lw 1.5 pt 4 ps 0.6 lc rgb '#80c060' title 'first frame', \
  peer('apriltag-36h11-d1') using 'markers':(ms('median_us')) \
    with linespoints lw 1.5 pt 9 ps 0.6 lc rgb '#c04000' title 'AprilTag', \
  peer('apriltag-36h11-d2') using 'markers':(ms('median_us')) \
    with linespoints lw 1.5 pt 8 ps 0.6 lc rgb '#e09040' title 'AprilTag, decimate 2', \
  peer('aruco') using 'markers':(ms('median_us')) \
    with linespoints lw 1.5 pt 11 ps 0.6 lc rgb '#905090' title 'ArUco'

set output sprintf('%s/growth-resolution.svg', folder)
set title 'how cost grows with resolution: 10 markers of 41 px (medians)'
unset logscale x
set xlabel 'width of the picture, pixels (16:9)'
set xrange [1000:4000]
set xtics (1280, 1920, 3840)
plot rows('resolution', 'following') using 'width':(ms('median_us')) \
    with linespoints lw 1.5 pt 7 ps 0.6 lc rgb '#0060b0' title 'following', \
  rows('resolution', 'first') using 'width':(ms('median_us')) \
    with linespoints lw 1.5 pt 6 ps 0.6 lc rgb '#60a0e0' title 'first frame', \
  rows('resolution', 'no marker') using 'width':(ms('median_us')) \
    with linespoints lw 1.5 pt 4 ps 0.6 lc rgb '#888888' title 'no marker in it'
