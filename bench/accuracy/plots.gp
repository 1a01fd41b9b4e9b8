# Pictures of what bench_accuracy measured.
#   gnuplot -e "folder='docs/results'" bench/accuracy/plots.gp
# Columns are taken by the names in the first line of the CSV files.

set datafile separator ','
set datafile columnheaders
set grid lc rgb '#dddddd'
set lmargin 8
set tmargin 2.5

systems = 'roundel roundel-whycon apriltag-16h5 apriltag-36h11 aruco aruco-subpix'
colours = '#0060b0 #60a0e0 #c04000 #e09040 #308030 #80c060'
points  = '7 6 5 4 9 8'
colour(i) = word(colours, i)
point(i) = int(word(points, i))

# The lines of one system: of one sweep; of all experiments.
sweep_rows(name, system) = sprintf( \
  "< awk -F, 'NR == 1 || ($1 == \"%s\" && $3 == \"%s\")' '%s/sweeps.csv'", name, system, folder)
set_rows(system) = sprintf( \
  "< awk -F, 'NR == 1 || $2 == \"%s\"' '%s/accuracy.csv'", system, folder)

array sweep = ['tilt', 'distance', 'noise', 'blur', 'gamma', 'size']
array what = ['angle between normal and line of sight, degrees', 'distance, m', \
  'noise, standard deviation in grey levels', 'blur, standard deviation in pixels', \
  'gamma of the camera, unknown to the tracker', "marker's diameter, pixels"]

do for [k = 1:|sweep|] {
  set terminal svg size 1200,380 background rgb 'white' font 'Helvetica,11'
  set output sprintf('%s/sweep-%s.svg', folder, sweep[k])
  set multiplot layout 1,4
  set xlabel what[k]
  set autoscale x
  unset logscale
  if (sweep[k] eq 'size' || sweep[k] eq 'distance') { set logscale x }
  set format y '%g'
  unset key

  set logscale y
  set autoscale y
  set title 'position error, mean, mm'
  plot sweep_rows(sweep[k], 'roundel') using 'value':'bound_rms_mm' \
      with lines dt 2 lw 1.5 lc rgb 'black', \
    for [i = 1:words(systems)] sweep_rows(sweep[k], word(systems, i)) \
      using 'value':'position_mean_mm' with linespoints lw 1.5 ps 0.5 pt point(i) lc rgb colour(i)
  set title 'orientation error, mean, rad'
  plot for [i = 1:words(systems)] sweep_rows(sweep[k], word(systems, i)) \
      using 'value':'phi_mean' with linespoints lw 1.5 ps 0.5 pt point(i) lc rgb colour(i)
  unset logscale y
  set yrange [0:105]
  set title 'found, %'
  plot for [i = 1:words(systems)] sweep_rows(sweep[k], word(systems, i)) \
      using 'value':'found_percent' with linespoints lw 1.5 ps 0.5 pt point(i) lc rgb colour(i)

  # The legend takes the fourth place.
  unset title
  unset xlabel
  unset tics
  unset border
  unset logscale x
  set key left center samplen 2 spacing 1.4
  set xrange [0:1]
  plot for [i = 1:words(systems)] NaN \
      with linespoints lw 1.5 pt point(i) lc rgb colour(i) title word(systems, i), \
    NaN with lines dt 2 lw 1.5 lc rgb 'black' title 'Cramér–Rao bound (rms), roundel'
  unset multiplot
  set tics
  set border
  set grid lc rgb '#dddddd'
}

# All experiments.
set terminal svg size 1200,420 background rgb 'white' font 'Helvetica,11'
set key outside right center samplen 1
set xtics rotate by 30 right noenhanced
set autoscale
set logscale y
set format y '%g'
set offsets 0.5, 0.5, 0, 0
set bmargin 7
array metric = ['position_mean_mm', 'phi_mean']
array metric_title = ['position error, mean, mm', 'orientation error, mean, rad']
array metric_file = ['position', 'orientation']
do for [m = 1:2] {
  set output sprintf('%s/%s.svg', folder, metric_file[m])
  set title metric_title[m]
  plot for [i = 1:words(systems)] set_rows(word(systems, i)) \
    using 0:metric[m]:xticlabel('set') with points ps 1.1 lw 1.5 pt point(i) lc rgb colour(i) \
    title word(systems, i) noenhanced
}

# Ids: how often they are right, by their probability. A bin's area is the number of its readings.
reliability = folder . '/reliability.csv'
set terminal svg size 520,480 background rgb 'white' font 'Helvetica,11'
set output folder . '/reliability.svg'
reset
set datafile separator ','
set datafile columnheaders
set grid lc rgb '#dddddd'
set title 'share of right ids by their stated probability'
set xlabel 'id_probability'
set ylabel 'right'
set xrange [0:1.02]
set yrange [0:1.02]
unset key
plot x with lines dt 2 lc rgb 'black', \
  reliability using 'mean_probability':'share_right':(0.3 * log10(column('count') + 1)) \
    with linespoints lw 1.5 pt 7 ps variable lc rgb '#0060b0'
