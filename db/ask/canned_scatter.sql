SELECT point_id, n,
  largest_fraction_sd / largest_fraction_mean AS largest_fraction_scatter,
  second_fraction_sd / second_fraction_mean AS second_fraction_scatter,
  fragment_count_sd / fragment_count_mean AS fragment_count_scatter,
  dust_fraction_sd / dust_fraction_mean AS dust_fraction_scatter,
  mean_fragment_mass_sd / mean_fragment_mass_mean AS mean_fragment_mass_scatter
FROM points WHERE n > 1 ORDER BY point_id
