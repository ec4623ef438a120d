"""Reading files, exact numbers, linear algebra, Krawczyk's test: what every kind needs."""
